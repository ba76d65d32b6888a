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

}  // namespace
}  // namespace footing::momentum
