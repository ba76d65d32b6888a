#include "common/sphere/disc_model.h"

#include <algorithm>

namespace footing::sphere::disc {
namespace {

/// Slopes of a profile along the tangent and along the blur in pixels, from those along `beyond`
/// and along blur over tangent.
Eigen::Vector2d EdgeSlopes(double along_beyond, double along_ratio, double beyond, double blur,
                           double tangent, double blur_px) {
  const double ratio = blur / tangent;
  return {-along_beyond / blur - along_ratio * ratio / tangent,
          (-along_beyond * beyond + along_ratio * ratio) / blur_px};
}

}  // namespace

Modelled Model(const Eigen::Vector2d& slopes, const State& state, const PixelScale& scale,
               const ProfileTable& table) {
  const Shape& p = state.shape;
  const double tangent = p[2];
  const Eigen::Vector2d from(slopes.x() - p[0], slopes.y() - p[1]);
  const double r = std::max(1e-9, from.norm());
  const Eigen::Vector2d unit = from / r;
  const double blur = p[3] * scale.Along(unit);
  Modelled result;
  // Blur along a curved edge moves it inwards by its variance over twice the radius. The table's
  // blur is the same in all directions; off the optical axis it is not.
  const double inwards = p[3] * p[3] * scale.Excess(unit) / (2 * tangent);
  result.beyond = (r - tangent + inwards) / blur;
  const ProfileValue profile = table.At(result.beyond, blur / tangent);
  result.cover = profile.disc;
  result.cover_slope << -unit * (profile.disc_d / blur),
      EdgeSlopes(profile.disc_d, profile.disc_blur, result.beyond, blur, tangent, p[3]);
  const double disc = profile.disc - p[4] * profile.limb;
  const double disc_d = profile.disc_d - p[4] * profile.limb_d;
  const double disc_blur = profile.disc_blur - p[4] * profile.limb_blur;
  const Eigen::Vector2d gradient(p[5], p[6]);
  const double tilt = 1 + gradient.dot(from) / tangent;
  // The blur of a product: x f blurred is x times f blurred, and the variance times its slope.
  result.light = disc * tilt + gradient.dot(unit) * disc_d * blur / tangent;
  Shape& slope = result.light_slope;
  slope.head<2>() = -unit * (disc_d / blur * tilt) - gradient * (disc / tangent);
  slope.segment<2>(2) = tilt * EdgeSlopes(disc_d, disc_blur, result.beyond, blur, tangent, p[3]);
  slope[2] -= disc * (tilt - 1) / tangent;
  slope[4] = -profile.limb * tilt;
  slope.tail<2>() = (disc * from + disc_d * blur * unit) / tangent;
  return result;
}

ModelledMoving ModelMoving(const Eigen::Vector2d& slopes, const State& state,
                           const PixelScale& scale, const ProfileTable& table) {
  constexpr double kPartBlurs = 2.5;  // Two points of Gauss stand for that: 0.5 % of the contrast.
  constexpr int kMostParts = 4;
  const double travel_blurs = state.motion_px.norm() / state.shape[3];
  const int parts =
      std::clamp(static_cast<int>(std::ceil(travel_blurs / kPartBlurs)), 1, kMostParts);
  const double later = scale.Later(slopes - state.shape.head<2>());
  const Eigen::Vector2d travel = scale.scale() * state.motion_px;
  ModelledMoving sum;
  sum.light_slope.setZero();
  sum.cover_slope.setZero();
  const double share = 1.0 / (2 * parts);
  for (int i = 0; i < 2 * parts; ++i) {
    const double middle = (i / 2 + 0.5) / parts - 0.5;
    const double at = later + middle + (i % 2 == 0 ? -1 : 1) * 0.5 / (parts * std::sqrt(3.0));
    const Modelled one = Model(slopes - at * travel, state, scale, table);
    sum.light += share * one.light;
    sum.cover += share * one.cover;
    sum.beyond += share * one.beyond;
    sum.light_slope += share * one.light_slope;
    sum.cover_slope += share * one.cover_slope;
    sum.light_motion += share * at * one.light_slope.head<2>();
    sum.cover_motion += share * at * one.cover_slope.head<2>();
  }
  sum.light_motion = scale.scale().transpose() * sum.light_motion;
  sum.cover_motion = scale.scale().transpose() * sum.cover_motion;
  return sum;
}

}  // namespace footing::sphere::disc
