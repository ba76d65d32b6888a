#include "common/virtual/camera/random_scene.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace footing::virtual_camera {
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

}  // namespace footing::virtual_camera
