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

Modelled Model(const Sample& sample, const State& state, const BlurScale& scale,
               const ProfileTable& table) {
  const Shape& p = state.shape;
  const double tangent = p[2];
  const Eigen::Vector2d from(sample.slopes.x() - p[0], sample.slopes.y() - p[1]);
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

void Equations::Assemble(Normal& normal, Right& right) const {
  normal.setZero();
  right.setZero();
  for (int c = 0; c < 3; ++c) {
    const auto& part = per_channel_[static_cast<std::size_t>(c)];
    const auto& part_right = right_[static_cast<std::size_t>(c)];
    const int own = kShape + 2 * c;
    normal.topLeftCorner<kShape, kShape>() += part.topLeftCorner<kShape, kShape>();
    normal.block<kShape, 2>(0, own) = part.topRightCorner<kShape, 2>();
    normal.block<2, kShape>(own, 0) = part.bottomLeftCorner<2, kShape>();
    normal.block<2, 2>(own, own) = part.bottomRightCorner<2, 2>();
    right.head<kShape>() += part_right.head<kShape>();
    right.segment<2>(own) = part_right.tail<2>();
    // A channel without pixels, as two of YUYV.
    for (int i = own; i < own + 2; ++i)
      if (normal(i, i) <= 0) normal(i, i) = 1;
  }
}

}  // namespace footing::sphere::disc
