#include "common/virtual/camera/scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include <Eigen/LU>

#include "common/virtual/camera/canvas.h"
#include "common/virtual/camera/render.h"

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

namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kLeastHueApartRad = 25 * kPi / 180;

/// Angle of a colour around the grey axis.
double Hue(const Eigen::Vector3d& colour) {
  return std::atan2(std::sqrt(3.0) * (colour.y() - colour.z()),
                    2 * colour.x() - colour.y() - colour.z());
}

/// A fully saturated colour of this hue whose largest channel is 1.
Eigen::Vector3d Saturated(double hue_rad) {
  Eigen::Vector3d colour;
  for (int i = 0; i < 3; ++i) colour[i] = std::cos(hue_rad - 2 * kPi * i / 3);
  colour.array() -= colour.minCoeff();
  return colour / colour.maxCoeff();
}

bool Touches(const Scene& scene, const Shape& shape, const Ball& ball) {
  const double radius_px = scene.lens.fx_px * ball.radius_m / ball.p_C_m.z();
  const double apart_px = (Project(scene.lens, ball.p_C_m) - shape.centre_px).norm();
  return apart_px < shape.half_px.norm() + 1.5 * radius_px + 4;
}

bool IsConfused(const Scene& scene, const Shape& shape) {
  return std::any_of(scene.balls.begin(), scene.balls.end(), [&](const Ball& ball) {
    const double apart = std::remainder(Hue(shape.colour_dn) - Hue(ball.colour_dn), 2 * kPi);
    return std::abs(apart) < kLeastHueApartRad && Touches(scene, shape, ball);
  });
}

Shape RandomShape(const Scene& scene, noise::Random& random) {
  Shape shape;
  shape.kind = random.Uniform() < 0.5 ? Shape::Kind::kRectangle : Shape::Kind::kEllipse;
  shape.centre_px = {random.Uniform(0, scene.lens.width), random.Uniform(0, scene.lens.height)};
  shape.half_px = {random.Uniform(3, 40), random.Uniform(3, 40)};
  if (random.Uniform() < 0.3) shape.half_px.y() = shape.half_px.x();
  shape.turn_rad = random.Uniform(0, kPi);
  shape.colour_dn =
      random.Uniform(10, random.Uniform() < 0.5 ? 50 : 120) * Saturated(random.Uniform(0, 2 * kPi));
  return shape;
}

}  // namespace

Eigen::Vector3d PlaceInView(const Lens& lens, double depth_m, double share, noise::Random& random) {
  const double edge = 0.5 * (1 - share);
  const Eigen::Vector2d pixel(lens.width * random.Uniform(edge, 1 - edge),
                              lens.height * random.Uniform(edge, 1 - edge));
  const Eigen::Vector3d ray = RayThrough(lens, pixel);
  return ray * (depth_m / ray.z());
}

void AddClutter(Scene& scene, int count, noise::Random& random) {
  for (int i = 0; i < count; ++i) {
    Shape shape = RandomShape(scene, random);
    while (IsConfused(scene, shape))
      shape.colour_dn = shape.colour_dn.maxCoeff() * Saturated(random.Uniform(0, 2 * kPi));
    scene.shapes.push_back(shape);
  }
  Shape lamp = RandomShape(scene, random);
  lamp.kind = Shape::Kind::kEllipse;
  lamp.half_px = {random.Uniform(8, 25), random.Uniform(8, 25)};
  lamp.colour_dn.setConstant(400);
  scene.shapes.push_back(lamp);
}

Occluder Hide(const Scene& scene, const Ball& ball, double share, noise::Random& random) {
  // Area of a unit disc beyond a chord at distance x: acos(x) - x sqrt(1 - x²).
  double low = -1, high = 1;
  for (int i = 0; i < 50; ++i) {
    const double x = 0.5 * (low + high);
    const double beyond = (std::acos(x) - x * std::sqrt(1 - x * x)) / kPi;
    (beyond > share ? low : high) = x;
  }
  const double radius_px = scene.lens.fx_px * ball.radius_m / ball.p_C_m.z();
  const double angle = random.Uniform(0, 2 * kPi);
  Occluder occluder;
  occluder.towards_hidden = {std::cos(angle), std::sin(angle)};
  occluder.point_px = Project(scene.lens, ball.p_C_m) + low * radius_px * occluder.towards_hidden;
  return occluder;
}

namespace {

/// Colours that a pixel lacks are the mean of those of its eight neighbours.
std::array<double, 3> Demosaiced(const Mosaic& mosaic, int u, int v) {
  std::array<double, 3> sum{}, count{};
  for (int dv = -1; dv <= 1; ++dv) {
    for (int du = -1; du <= 1; ++du) {
      const int at_u = u + du, at_v = v + dv;
      if (at_u < 0 || at_u >= mosaic.width || at_v < 0 || at_v >= mosaic.height) continue;
      const std::size_t channel = (at_u + at_v) % 2 == 0 ? 1 : at_v % 2 == 0 ? 0 : 2;
      const bool own = (u + v) % 2 == 0 ? channel == 1 : (v % 2 == 0 ? 0u : 2u) == channel;
      if (own && (du != 0 || dv != 0)) continue;
      sum[channel] += mosaic.bytes[static_cast<std::size_t>(at_v * mosaic.width + at_u)];
      count[channel] += 1;
    }
  }
  for (std::size_t i = 0; i < 3; ++i) sum[i] /= std::max(1.0, count[i]);
  return sum;
}

std::uint8_t Byte(double value) {
  return static_cast<std::uint8_t>(std::clamp(std::round(value), 0.0, 255.0));
}

}  // namespace

std::vector<std::uint8_t> ToYuyv(const Mosaic& mosaic) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(2 * mosaic.bytes.size());
  for (int v = 0; v < mosaic.height; ++v) {
    for (int u = 0; u + 1 < mosaic.width; u += 2) {
      double luma[2], blue = 0, red = 0;
      for (int i = 0; i < 2; ++i) {
        const auto [r, g, b] = Demosaiced(mosaic, u + i, v);
        luma[i] = 0.299 * r + 0.587 * g + 0.114 * b;
        blue += 0.5 * 0.564 * (b - luma[i]);
        red += 0.5 * 0.713 * (r - luma[i]);
      }
      for (const double value : {luma[0], 128 + blue, luma[1], 128 + red})
        bytes.push_back(Byte(value));
    }
  }
  return bytes;
}

namespace {

/// Light of the sheet along a ray from the camera; both in the sheet's frame.
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
