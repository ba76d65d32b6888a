#include "common/virtual/camera/lens.h"

#include <Eigen/LU>

namespace footing::virtual_camera {
namespace {

Eigen::Vector2d Distorted(const Lens& lens, const Eigen::Vector2d& at) {
  const double x = at.x(), y = at.y(), r2 = at.squaredNorm();
  const double radial = 1 + r2 * (lens.k1 + r2 * (lens.k2 + r2 * lens.k3));
  return {x * radial + 2 * lens.p1 * x * y + lens.p2 * (r2 + 2 * x * x),
          y * radial + lens.p1 * (r2 + 2 * y * y) + 2 * lens.p2 * x * y};
}

}  // namespace

Eigen::Vector2d Project(const Lens& lens, const Eigen::Vector3d& p_C_m) {
  const Eigen::Vector2d at = Distorted(lens, p_C_m.head<2>() / p_C_m.z());
  return {lens.fx_px * at.x() + lens.cx_px, lens.fy_px * at.y() + lens.cy_px};
}

Eigen::Vector3d RayThrough(const Lens& lens, const Eigen::Vector2d& pixel) {
  const Eigen::Vector2d seen((pixel.x() - lens.cx_px) / lens.fx_px,
                             (pixel.y() - lens.cy_px) / lens.fy_px);
  Eigen::Vector2d at = seen;
  constexpr double kStep = 1e-6;
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector2d miss = Distorted(lens, at) - seen;
    if (miss.norm() < 1e-12) break;
    Eigen::Matrix2d slope;
    for (int k = 0; k < 2; ++k) {
      const Eigen::Vector2d step = kStep * Eigen::Vector2d::Unit(k);
      slope.col(k) = (Distorted(lens, at + step) - Distorted(lens, at - step)) / (2 * kStep);
    }
    at -= slope.inverse() * miss;
  }
  return Eigen::Vector3d(at.x(), at.y(), 1).normalized();
}

}  // namespace footing::virtual_camera
