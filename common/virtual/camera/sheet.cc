#include "common/virtual/camera/sheet.h"

#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "common/virtual/camera/canvas.h"
#include "common/virtual/camera/render.h"

namespace footing::virtual_camera {
namespace {

/// What a ray from the camera meets of the sheet; both in the sheet's frame.
std::optional<Eigen::Vector3d> SheetLight(const DotSheet& sheet, const Eigen::Vector3d& camera_S,
                                          const Eigen::Vector3d& ray_S) {
  const double reach = -camera_S.z() / ray_S.z();
  if (!(reach > 0)) return std::nullopt;
  const Eigen::Vector2d at = (camera_S + reach * ray_S).head<2>();
  const Eigen::Vector2d last(sheet.columns - 1, sheet.rows - 1);
  const Eigen::Vector2d half_m = 0.5 * sheet.pitch_m * last;
  if ((at.cwiseAbs() - half_m).maxCoeff() > sheet.margin_m + sheet.radius_m) return std::nullopt;
  const Eigen::Vector2d cell = (at + half_m) / sheet.pitch_m;
  const Eigen::Vector2d nearest = cell.array().round().max(0).min(last.array());
  const bool is_ink = (cell - nearest).norm() * sheet.pitch_m < sheet.radius_m;
  return is_ink ? sheet.ink_dn : sheet.paper_dn;
}

}  // namespace

Mosaic RenderSheet(const Scene& scene, const DotSheet& sheet, noise::Random& random) {
  constexpr int kFold = 4;
  const Eigen::Isometry3d X_SC = sheet.X_CS.inverse();
  Canvas canvas(scene.lens.width, scene.lens.height);
  std::vector<Eigen::Vector3d> upper, lower;  // Rays at the corners above and below a row.
  for (int v = 0; v <= canvas.height(); ++v) {
    lower.clear();
    for (int u = 0; u <= canvas.width(); ++u)
      lower.push_back(X_SC.linear() * RayThrough(scene.lens, {u - 0.5, v - 0.5}));
    for (std::size_t u = 0; v > 0 && u + 1 < upper.size(); ++u) {
      Eigen::Vector3d light = Eigen::Vector3d::Zero();
      for (int i = 0; i < kFold * kFold; ++i) {
        const double a = (i % kFold + 0.5) / kFold, b = (i / kFold + 0.5) / kFold;
        const Eigen::Vector3d ray = (1 - b) * ((1 - a) * upper[u] + a * upper[u + 1]) +
                                    b * ((1 - a) * lower[u] + a * lower[u + 1]);
        light += SheetLight(sheet, X_SC.translation(), ray).value_or(scene.background_dn);
      }
      Eigen::Map<Eigen::Vector3f>(canvas.At(static_cast<int>(u), v - 1)) =
          (light / (kFold * kFold)).cast<float>();
    }
    std::swap(upper, lower);
  }
  canvas.Blur(scene.sensor.psf_px);
  return ReadOut(scene, canvas, random);
}

}  // namespace footing::virtual_camera
