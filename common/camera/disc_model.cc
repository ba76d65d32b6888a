#include "common/camera/disc_model.h"

#include <algorithm>

namespace footing::sphere::disc {
namespace {

/// Profiles of both discs, for each pixel.
struct Profiles {
  Lane disc, limb, disc_d, limb_d, disc_blur, limb_blur;
};

void LookUp(const Lane& beyond, const Lane& ratio, const ProfileTable& table, Profiles& out) {
  for (int i = 0; i < kBlock; ++i) {
    const ProfileValue value = table.At(beyond[i], ratio[i]);
    out.disc[i] = value.disc;
    out.limb[i] = value.limb;
    out.disc_d[i] = value.disc_d;
    out.limb_d[i] = value.limb_d;
    out.disc_blur[i] = value.disc_blur;
    out.limb_blur[i] = value.limb_blur;
  }
}

/// The shape's parameters in single precision.
struct Numbers {
  explicit Numbers(const Shape& p)
      : axis_s(float(p[0])),
        axis_t(float(p[1])),
        tangent(float(p[2])),
        per_tangent(float(1 / p[2])),
        blur_px(float(p[3])),
        per_blur_px(float(1 / p[3])),
        limb(float(p[4])),
        gradient_s(float(p[5])),
        gradient_t(float(p[6])) {}
  float axis_s, axis_t, tangent, per_tangent, blur_px, per_blur_px, limb, gradient_s, gradient_t;
};

}  // namespace

void Model(const Lane& s, const Lane& t, const State& state, const PixelScale& scale,
           const ProfileTable& table, Modelled& result) {
  const Numbers p(state.shape);
  const Eigen::Matrix2f square = scale.square().cast<float>();
  const Eigen::Matrix2f per_s = scale.square_change(0).cast<float>();
  const Eigen::Matrix2f per_t = scale.square_change(1).cast<float>();
  const auto square_at = [&](int i, int k) -> Lane {
    return square(i, k) + per_s(i, k) * s + per_t(i, k) * t;
  };
  const Lane square_ss = square_at(0, 0), square_st = square_at(0, 1), square_tt = square_at(1, 1);
  const Lane x = s - p.axis_s, y = t - p.axis_t;
  const Lane r = (x * x + y * y).sqrt().max(1e-9F);
  const Lane unit_s = x / r, unit_t = y / r;
  const Lane along2 =
      square_ss * unit_s * unit_s + 2 * square_st * unit_s * unit_t + square_tt * unit_t * unit_t;
  const Lane blur = p.blur_px * along2.sqrt(), per_blur = 1 / blur;
  // Blur along a curved edge moves it inwards by its variance over twice the radius. The table's
  // blur is the same in all directions; off the optical axis it is not.
  const Lane inwards =
      0.5F * p.blur_px * p.blur_px * p.per_tangent * (square_ss + square_tt - 2 * along2);
  const Lane beyond = (r - p.tangent + inwards) * per_blur, ratio = blur * p.per_tangent;
  Profiles profile;
  LookUp(beyond, ratio, table, profile);
  result.beyond = beyond;
  // Along the tangent and along the blur in pixels, from slopes along `beyond` and along `ratio`.
  const auto along_tangent = [&](const Lane& along_beyond, const Lane& along_ratio) {
    return -along_beyond * per_blur - along_ratio * ratio * p.per_tangent;
  };
  const auto along_blur = [&](const Lane& along_beyond, const Lane& along_ratio) {
    return (along_ratio * ratio - along_beyond * beyond) * p.per_blur_px;
  };
  result.cover = profile.disc;
  const Lane cover_r = profile.disc_d * per_blur;
  result.cover_slope[0] = -unit_s * cover_r;
  result.cover_slope[1] = -unit_t * cover_r;
  result.cover_slope[2] = along_tangent(profile.disc_d, profile.disc_blur);
  result.cover_slope[3] = along_blur(profile.disc_d, profile.disc_blur);
  const Lane disc = profile.disc - p.limb * profile.limb;
  const Lane disc_d = profile.disc_d - p.limb * profile.limb_d;
  const Lane disc_blur = profile.disc_blur - p.limb * profile.limb_blur;
  const Lane tilt = 1 + (p.gradient_s * x + p.gradient_t * y) * p.per_tangent;
  // The blur of a product: x f blurred is x times f blurred, and the variance times its slope.
  const Lane blurred = disc_d * blur * p.per_tangent;
  result.light = disc * tilt + (p.gradient_s * unit_s + p.gradient_t * unit_t) * blurred;
  std::array<Lane, kShape>& slope = result.light_slope;
  const Lane light_r = disc_d * per_blur * tilt, level = disc * p.per_tangent;
  slope[0] = -unit_s * light_r - p.gradient_s * level;
  slope[1] = -unit_t * light_r - p.gradient_t * level;
  slope[2] = tilt * along_tangent(disc_d, disc_blur) - level * (tilt - 1);
  slope[3] = tilt * along_blur(disc_d, disc_blur);
  slope[4] = -profile.limb * tilt;
  slope[5] = level * x + blurred * unit_s;
  slope[6] = level * y + blurred * unit_t;
}

void ModelMoving(const Lane& s, const Lane& t, const Lane& later, const State& state,
                 const PixelScale& scale, const ProfileTable& table, ModelledMoving& sum) {
  constexpr double kPartBlurs = 2.5;  // Two points of Gauss stand for that: 0.5 % of the contrast.
  constexpr int kMostParts = 4;
  const double travel_blurs = state.motion_px.norm() / state.shape[3];
  const int parts =
      std::clamp(static_cast<int>(std::ceil(travel_blurs / kPartBlurs)), 1, kMostParts);
  const Eigen::Vector2f travel = (scale.scale() * state.motion_px).cast<float>();
  for (Lane* lane : {&sum.light, &sum.cover, &sum.beyond}) lane->setZero();
  std::array<Lane, kMotion> light_motion, cover_motion;  // Axis s and t, tangent.
  for (auto* lanes : {&light_motion, &cover_motion})
    for (Lane& lane : *lanes) lane.setZero();
  for (Lane& lane : sum.light_slope) lane.setZero();
  for (Lane& lane : sum.cover_slope) lane.setZero();
  const auto share = static_cast<float>(1.0 / (2 * parts));
  for (int i = 0; i < 2 * parts; ++i) {
    const double middle = (i / 2 + 0.5) / parts - 0.5;
    const double point = middle + (i % 2 == 0 ? -1 : 1) * 0.5 / (parts * std::sqrt(3.0));
    const Lane at = later + static_cast<float>(point);
    Modelled one;
    Model(s - at * travel.x(), t - at * travel.y(), state, scale, table, one);
    sum.light += share * one.light;
    sum.cover += share * one.cover;
    sum.beyond += share * one.beyond;
    for (std::size_t k = 0; k < one.light_slope.size(); ++k)
      sum.light_slope[k] += share * one.light_slope[k];
    for (std::size_t k = 0; k < one.cover_slope.size(); ++k)
      sum.cover_slope[k] += share * one.cover_slope[k];
    for (std::size_t k = 0; k < kMotion; ++k) {
      light_motion[k] += share * at * one.light_slope[k];
      cover_motion[k] += share * at * one.cover_slope[k];
    }
  }
  const Eigen::Matrix2f to_px = scale.scale().cast<float>();
  for (int k = 0; k < 2; ++k) {
    const auto at = static_cast<std::size_t>(k);
    sum.light_motion[at] = to_px(0, k) * light_motion[0] + to_px(1, k) * light_motion[1];
    sum.cover_motion[at] = to_px(0, k) * cover_motion[0] + to_px(1, k) * cover_motion[1];
  }
  // A sphere grows by a hundredth at most: linear.
  const auto tangent = static_cast<float>(state.shape[2]),
             growth = static_cast<float>(state.growth);
  sum.light_motion[2] = tangent * light_motion[2];
  sum.cover_motion[2] = tangent * cover_motion[2];
  sum.light += growth * sum.light_motion[2];
  sum.cover += growth * sum.cover_motion[2];
}

}  // namespace footing::sphere::disc
