#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "daemon/simulation/momentum/best_estimator.h"
#include "daemon/simulation/momentum/horizontal_doubt.h"
#include "tests/simulation/momentum/made_body.h"

// Bodies that do not stay in place, and what hands and feet show of them.
namespace footing::momentum {
namespace {

constexpr double kPostureOffM = 0.05;  // By which hands and feet have C too far ahead.

constexpr double kPushS = 0.25, kFlightS = 0.3;

/// Where a push of `acceleration`, a flight under `gravity` and the push's contrary lead, from
/// rest.
double Hopped(double t, double acceleration, double gravity) {
  const double push = std::clamp(t, 0.0, kPushS), flight = std::clamp(t - kPushS, 0.0, kFlightS);
  const double land = std::clamp(t - kPushS - kFlightS, 0.0, kPushS);
  const double off = acceleration * kPushS, down = off - gravity * kFlightS;
  const double stop = down / kPushS;
  return 0.5 * acceleration * push * push + off * flight - 0.5 * gravity * flight * flight +
         down * land - 0.5 * stop * land * land;
}

/// Hops 0.55 m ahead, from t = 1 on.
MadeBody Hopper() {
  MadeBody body;
  const double up_mps2 = 0.5 * kStandardGravityMps2 * kFlightS / kPushS;
  body.com_m = [up_mps2](double t) {
    return Eigen::Vector3d(Hopped(t - 1, 4, 0), 0,
                           kMadeHeightM + Hopped(t - 1, up_mps2, kStandardGravityMps2));
  };
  return body;
}

MadeBody Swayer() {
  MadeBody body;
  body.com_m = [](double t) {
    return Eigen::Vector3d(t > 0 ? 0.03 * Ramp(t) * std::sin(3 * t) : 0, 0, kMadeHeightM);
  };
  return body;
}

struct Seen {
  double worst_m = 0;        ///< The forward place is off by.
  double worst_spreads = 0;  ///< And by so many of its standard deviations.
  double last_m = 0;         ///< The forward place in the end.
};

Seen Watch(MadeBody body, bool sees_posture, double lag_s = 0) {
  BestConfig config;
  config.lag_s = lag_s;
  BestEstimator best(config, {}, body.Calibrate(), kMadeStepS);
  Seen seen;
  for (double t = 0; t < 1.9; t += kMadeStepS) {
    best.Advance(body.At(t));
    const Eigen::Vector3d c = body.com_m(t);
    if (sees_posture) best.SeePosture(0, {c.x() + kPostureOffM, 0, kMadeHeightM});
    const Estimate& now = best.estimate();
    const double off_m = std::abs(now.p_WC_m.x() - body.com_m(t - lag_s).x());
    seen.worst_m = std::max(seen.worst_m, off_m);
    seen.worst_spreads =
        std::max(seen.worst_spreads, off_m / std::sqrt(now.position_variance_m2.x()));
    seen.last_m = now.p_WC_m.x();
  }
  return seen;
}

TEST(BestEstimator, FollowsABodyThatHopsByHandsAndFeet) {
  const Seen alone = Watch(Hopper(), false), seen = Watch(Hopper(), true);
  EXPECT_GT(alone.worst_m, 0.3) << "the filter of bodies in place takes it for a lean";
  EXPECT_LT(alone.worst_spreads, 5) << "but doubts it (18 deviations without the doubt)";
  EXPECT_LT(seen.worst_m, 0.5 * alone.worst_m);
  EXPECT_LT(seen.worst_spreads, 3.5);
  const Seen lagged = Watch(Hopper(), true, 0.2);
  EXPECT_LT(lagged.worst_m, seen.worst_m);
}

TEST(BestEstimator, HandsAndFeetDoNotMoveABodyInPlaceForwards) {
  EXPECT_NEAR(Watch(Swayer(), true).last_m, Watch(Swayer(), false).last_m, 1e-5);
  EXPECT_LT(Watch(Swayer(), true).worst_m, 0.03);
}

TEST(HorizontalDoubt, MovesAsFarAsTheDoubtGoes) {
  const HorizontalCom::Filter::Scalar in_place{0, 1e-4}, travelling{0.2, 1e-2};
  const auto none = Weigh(in_place, 0, travelling);
  EXPECT_EQ(none.mean, in_place.mean);
  EXPECT_EQ(none.variance, in_place.variance);
  const auto half = Weigh(in_place, travelling.variance, travelling);
  EXPECT_NEAR(half.mean, 0.1, 1e-12);
  EXPECT_NEAR(half.variance, 0.25 * (1e-4 + 2e-2), 1e-12);
  const auto all = Weigh(in_place, 1e6, travelling);
  EXPECT_NEAR(all.mean, travelling.mean, 1e-6);
  EXPECT_NEAR(all.variance, travelling.variance, 1e-6);
}

}  // namespace
}  // namespace footing::momentum
