#include "clients/view/scene/part.h"

#include <cmath>

namespace footing::scene {
namespace {

constexpr float kShortestM = 1e-5f;

/// Three axes of length 1 with z along `direction`.
Eigen::Matrix3f AxesAlong(const Eigen::Vector3f& direction) {
  Eigen::Matrix3f axes;
  axes.col(2) = direction.normalized();
  axes.col(0) = axes.col(2).unitOrthogonal();
  axes.col(1) = axes.col(2).cross(axes.col(0));
  return axes;
}

float Linear(std::uint32_t byte) {
  const float value = static_cast<float>(byte) / 255;
  return value <= 0.04045f ? value / 12.92f : std::pow((value + 0.055f) / 1.055f, 2.4f);
}

}  // namespace

Eigen::Matrix4f Ellipsoid(const Eigen::Vector3f& centre, const Eigen::Matrix3f& axes,
                          const Eigen::Vector3f& half_axes) {
  Eigen::Matrix4f X = Eigen::Matrix4f::Identity();
  X.topLeftCorner<3, 3>() = axes * half_axes.asDiagonal();
  X.topRightCorner<3, 1>() = centre;
  return X;
}

void PartList::AddBall(const Eigen::Matrix4f& X_WP, const Colour& colour, const Colour& under,
                       float gloss) {
  balls.push_back({X_WP, colour, 1, under, gloss});
}

void PartList::AddRod(const Eigen::Vector3f& a, const Eigen::Vector3f& b, float radius_a,
                      float radius_b, const Colour& colour, float gloss) {
  const float length = (b - a).norm();
  if (length < kShortestM) return;
  const Eigen::Matrix4f X = Ellipsoid(a, AxesAlong(b - a), {radius_a, radius_a, length});
  rods.push_back({X, colour, radius_b / radius_a, colour, gloss});
}

void PartList::AddBox(const Eigen::Vector3f& middle, const Eigen::Matrix3f& axes,
                      const Eigen::Vector3f& sides_m, const Colour& colour, float gloss) {
  boxes.push_back({Ellipsoid(middle, axes, sides_m), colour, 1, 0.8f * colour, gloss});
}

void PartList::AddDisc(const Eigen::Vector3f& centre, const Eigen::Vector2f& half_axes_m,
                       float yaw_rad, const Colour& colour) {
  constexpr float kHalfThicknessM = 0.0015f;
  const Eigen::Matrix3f axes =
      Eigen::AngleAxisf(yaw_rad, Eigen::Vector3f::UnitZ()).toRotationMatrix();
  balls.push_back({Ellipsoid(centre, axes, {half_axes_m.x(), half_axes_m.y(), kHalfThicknessM}),
                   colour, 1, colour, 0});
}

void PartList::AddLimb(const Eigen::Vector3f& a, const Eigen::Vector3f& b, float radius_a,
                       float radius_b, const Colour& colour, float gloss) {
  const float length = (b - a).norm();
  if (length < kShortestM) return;
  const Eigen::Matrix4f X = Ellipsoid(a, AxesAlong(b - a), {radius_a, radius_a, length});
  limbs.push_back({X, colour, radius_b / radius_a, colour, gloss});
}

void PartList::AddOvalLimb(const Eigen::Vector3f& a, const Eigen::Vector3f& b,
                           const Eigen::Vector3f& x_axis, float radius_a, float radius_b,
                           float oval, const Colour& colour, float gloss) {
  const float length = (b - a).norm();
  if (length < kShortestM) return;
  Eigen::Matrix3f axes;
  axes.col(2) = (b - a) / length;
  axes.col(1) = axes.col(2).cross(x_axis).normalized();
  axes.col(0) = axes.col(1).cross(axes.col(2));
  const Eigen::Matrix4f X = Ellipsoid(a, axes, {radius_a, oval * radius_a, length});
  limbs.push_back({X, colour, radius_b / radius_a, colour, gloss});
}

Colour Rgb(std::uint32_t hex) {
  return {Linear((hex >> 16) & 0xff), Linear((hex >> 8) & 0xff), Linear(hex & 0xff)};
}

}  // namespace footing::scene
