#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "daemon/simulation/momentum/best_estimator.h"
#include "tests/simulation/momentum/made_body.h"

namespace footing::momentum {
namespace {

// The greatest error of the height from 0.1 to 0.75 s after a fall of 2 m/s onto the cells, in
// reported deviations. The knees give way by 40 cm, of which the posture sees `seen`.
double WorstOfALanding(double seen) {
  constexpr double kLandS = 0.3, kFallMps = 2, kBrakeMps2 = 5;
  const auto height_m = [=](double t) {
    const double s = std::min(t - kLandS, kFallMps / kBrakeMps2);
    return kMadeHeightM - kFallMps * s + 0.5 * s * s * (s < 0 ? -kStandardGravityMps2 : kBrakeMps2);
  };
  MadeBody body;
  body.noise_n = 0.5;
  body.com_m = [&](double t) {
    return Eigen::Vector3d(0, 0, t < 0.5 * kMadeStepS ? kMadeHeightM : height_m(t));
  };
  BestConfig config;
  config.height_posture = LearnedHeightPosture();
  BestEstimator best(config, {}, body.Calibrate(), kMadeStepS);
  double worst = 0;
  for (int i = 0; i < 63; ++i) {
    const double t = i * kMadeStepS;
    best.Advance(body.At(t));
    const double posture_m = kMadeHeightM + seen * (height_m(t) - kMadeHeightM);
    const Estimate& now = best.SeePosture(0, {0, 0, posture_m});
    if (t < kLandS + 0.1) continue;
    const double off_m = std::abs(now.p_WC_m.z() - height_m(t));
    worst = std::max(worst, off_m / std::sqrt(now.position_variance_m2.z()));
  }
  EXPECT_EQ(best.estimate().resets, 1u);
  return worst;
}

TEST(BestEstimator, KnowsThatAPostureDoesNotShowHowFarKneesGiveWayInALanding) {
  for (const double seen : {0.25, 1.0}) EXPECT_LT(WorstOfALanding(seen), 2) << seen;
}

// In the first frame in which a body is there again after two seconds: of silent cells, or of
// empty ones.
Estimate FirstFrameAfter(bool silence) {
  MadeBody body;
  BestEstimator best({}, {}, body.Calibrate(), kMadeStepS);
  for (int i = 0; i < 120; ++i) {
    ContactLoads loads = body.At(i * kMadeStepS);
    for (FootLoads& foot : loads.feet) {
      foot.valid = !silence;
      for (Cell& cell : foot.cells) cell.load_n = 0;
    }
    best.Advance(loads);
  }
  return best.Advance(body.At(2));
}

TEST(BestEstimator, ABodyThatComesDownMayBeAsFastAsFromABoxAndOneThatReappearsStands) {
  const Estimate landing = FirstFrameAfter(false), standing = FirstFrameAfter(true);
  EXPECT_EQ(landing.resets, 1u);
  EXPECT_EQ(standing.resets, 1u);
  const double landing_sd_mps = std::sqrt(landing.velocity_variance_m2ps2.z());
  for (const double mps : {0.0, -3.0}) {
    EXPECT_NEAR(landing.v_WC_mps.z(), mps, 1.2 * landing_sd_mps);
  }
  EXPECT_NEAR(standing.v_WC_mps.z(), 0, 0.05);
  EXPECT_LT(std::sqrt(standing.velocity_variance_m2ps2.z()), 0.6);
}

}  // namespace
}  // namespace footing::momentum
