#include <algorithm>
#include <cmath>

#include "daemon/simulation/momentum/mixture.h"
#include "daemon/simulation/momentum/vertical_com.h"

// What the filter of the height makes of postures.
namespace footing::momentum {
namespace {

constexpr double kPostureLookS = 0.3;
constexpr double kPostureAnchorLookS = 0.5, kPostureAnchorsS = 0.1;
// A filter has strayed that is for a while so many deviations from the posture.
constexpr double kFarSpreads = 4, kFarS = 0.2, kDoubtSpreads = 3;
// How fast a posture rises, smoothed, says how fast the body does: in kSpeedRight of looks right to
// the sum of kSpeedMps and a share of itself, else, as where knees bend under still hands, to
// kWrongSpeedMps. On people left out 0.9, 0.02, 0.7 and 0.2 fit best; looks that follow each other
// so closely are not independent, hence more.
constexpr double kPostureSpeedS = 0.3, kSpeedLookS = 0.25, kSpeedSettlesS = 3 * kPostureSpeedS;
constexpr double kLandingS = 0.8;  // Until a body that has landed stands again, or leaps.
// Of landings so many are on straight legs; in the others the knees give way by up to 40 cm, of
// which a posture shows little.
constexpr double kStiffLandings = 0.5, kGivesWayM = 0.2, kGivesWaySpreadM = 0.12;
constexpr double kSpeedRight = 0.8, kSpeedMps = 0.04, kSpeedShare = 0.7, kWrongSpeedMps = 0.25;

/// A posture is off by so much, and may be by that variance.
template <typename Watched>
void Compare(double off_m, double variance_m2, double step_s, Watched& posture) {
  const bool far = off_m * off_m > kFarSpreads * kFarSpreads * variance_m2;
  posture.contradicted = off_m * off_m > kDoubtSpreads * kDoubtSpreads * variance_m2;
  posture.far_s = far ? posture.far_s + step_s : 0;
  posture.strayed = posture.strayed || posture.far_s > kFarS;
  posture.since_score_s += step_s;
}

}  // namespace

void VerticalCom::SeePosture(double height_m) {
  const PostureError& posture = config_.posture;
  if (posture.spread_m <= 0) return;
  if (posture.right_share > 0) {
    AnchorToPosture(height_m);
    return;
  }
  Filter::Row h = posture.share * Filter::Row::Unit(0);
  h(kPosture) = 1;
  filter_.Update(h, height_m, posture.white_m * posture.white_m);
  const double s = filter_.p()(0, 0) + posture.spread_m * posture.spread_m;
  const double off_m = height_m - posture.share * filter_.x()(0);
  Compare(off_m, s, step_s_, posture_);
  if (posture_.since_score_s >= kPostureLookS) {
    posture_.since_score_s = 0;
    Score(-0.5 * (off_m * off_m / s + std::log(s)));
  }
}

void VerticalCom::FollowSpeed(double height_m) {
  if (posture_.anchors_s <= 0) {
    posture_.level_m = height_m;
    posture_.gained_mps = 0;
    // From rest it is right at once.
    const bool rests = filter_.Of(Filter::Row::Unit(1)).variance < kSpeedMps * kSpeedMps;
    posture_.since_speed_s = rests ? 0 : -kSpeedSettlesS;
  }
  posture_.anchors_s = kPostureAnchorsS;
  const double share = step_s_ / (kPostureSpeedS + step_s_);
  posture_.speed_mps = (height_m - posture_.level_m) / kPostureSpeedS;
  posture_.level_m += share * (height_m - posture_.level_m);
  FollowHold(height_m);
  posture_.gained_mps = (1 - share) * (posture_.gained_mps + step_s_ * acceleration_mps2_);
  posture_.since_speed_s += step_s_;
  if (config_.by_rests && follows_loads()) return;
  if (posture_.since_speed_s < kSpeedLookS || !Loaded(last_.raw_mps2)) return;
  posture_.since_speed_s = 0;
  LookAtPostureSpeed();
}

void VerticalCom::LookAtPostureSpeed() {
  const Filter::Row row = Filter::Row::Unit(1);
  const Filter::Scalar now = filter_.Of(row);
  const double seen_mps = posture_.speed_mps + posture_.gained_mps;
  const double right_mps = kSpeedMps + kSpeedShare * std::abs(posture_.speed_mps);
  const MixtureMoments product = TimesMixture(
      {now.mean, now.variance},
      {{{kSpeedRight, seen_mps, right_mps}, {1 - kSpeedRight, seen_mps, kWrongSpeedMps}}});
  Score(product.log_evidence);
  filter_.SetMoments(row, {product.moments.mean, product.moments.variance});
}

void VerticalCom::Land(double height_m, double height_sd_m, double velocity_mps,
                       double velocity_sd_mps) {
  Reseed(height_m, height_sd_m, velocity_mps, velocity_sd_mps);
  posture_.landing_s = kLandingS;
  posture_.since_score_s = kLandingS;  // The first posture counts.
}

std::array<Component, 2> VerticalCom::ByPosture(double height_m) const {
  const PostureError& posture = config_.posture;
  if (posture_.landing_s > 0) {
    return {{{kStiffLandings, height_m, posture.right_m},
             {1 - kStiffLandings, height_m - kGivesWayM, kGivesWaySpreadM}}};
  }
  return {{{posture.right_share, height_m, posture.right_m},
           {1 - posture.right_share, height_m, posture.spread_m}}};
}

void VerticalCom::AnchorToPosture(double height_m) {
  const PostureError& posture = config_.posture;
  FollowSpeed(height_m);
  if (config_.by_rests) SeeRest(height_m);
  const Filter::Row row = Filter::Row::Unit(0);
  const Filter::Scalar now = filter_.Of(row);
  Compare(height_m - now.mean, now.variance + posture.spread_m * posture.spread_m, step_s_,
          posture_);
  if (config_.by_rests && follows_loads()) return;
  // What is less certain than a posture at its worst is not waited for; but looks at a landing
  // that follow each other are all wrong by the same.
  const bool lands = posture_.landing_s > 0;
  const bool lost = !lands && now.variance > posture.spread_m * posture.spread_m;
  const bool due = posture_.since_score_s >= kPostureAnchorLookS;
  if (!due && !lost) return;
  if (due) posture_.since_score_s = 0;
  const MixtureMoments product = TimesMixture({now.mean, now.variance}, ByPosture(height_m));
  if (due) Score(product.log_evidence);
  // No straight leg carries a body further up, however wrong the posture is about bent ones.
  const Moments posterior = Loaded(last_.raw_mps2)
                                ? Below(product.moments, std::max(height_m, 0.0) + kTiptoeM)
                                : product.moments;
  filter_.SetMoments(row, {posterior.mean, posterior.variance});
}

}  // namespace footing::momentum
