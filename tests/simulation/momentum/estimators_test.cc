#include <gtest/gtest.h>

#include <cmath>

#include "daemon/simulation/momentum/best_estimator.h"
#include "daemon/simulation/momentum/foot_place.h"
#include "tests/simulation/momentum/made_body.h"

namespace footing::momentum {
namespace {

bool Finite(const Estimate& e) {
  bool finite = e.p_WC_m.allFinite() && e.v_WC_mps.allFinite() && e.a_WC_mps2.allFinite() &&
                e.position_variance_m2.allFinite() && e.velocity_variance_m2ps2.allFinite() &&
                e.angular_momentum_kgm2ps.allFinite() && e.angular_momentum_variance.allFinite();
  for (const FootEstimate& foot : e.feet)
    finite = finite && foot.p_WF_m.allFinite() && foot.variance_m2.allFinite();
  return finite;
}

TEST(BestEstimator, HeightOfSquatsDoesNotDriftInTenMinutes) {
  MadeBody body = Squatter();
  const TPose pose = body.Calibrate();
  BestEstimator best({}, {}, pose, kMadeStepS);
  double first = 0, last = 0;
  constexpr int kFrames = 10 * 60 * 60, kMinute = 3600;
  for (int i = 0; i < kFrames; ++i) {
    const double t = i * kMadeStepS;
    const double error = best.Advance(body.At(t)).p_WC_m.z() - body.com_m(t).z();
    if (i < kMinute) first += error * error;
    if (i >= kFrames - kMinute) last += error * error;
  }
  EXPECT_LT(std::sqrt(first / kMinute), 0.03);
  EXPECT_LT(std::sqrt(last / kMinute), 0.03);
}

TEST(BestEstimator, OutlivesCellsWhoseGainIsWrongByOnePercent) {
  MadeBody body = Squatter();
  const TPose pose = [&] {
    TPoseCalibration calibration;
    for (int i = -400; i < 0; ++i) {
      ContactLoads loads = body.At(i * kMadeStepS);
      loads.feet[0].cells[0].load_n *= 1.01;
      loads.feet[1].cells[3].load_n *= 0.99;
      if (calibration.Advance(loads, kMadeStepS)) break;
    }
    return calibration.result();
  }();
  BestEstimator best({}, {}, pose, kMadeStepS);
  double sum = 0;
  constexpr int kFrames = 3 * 60 * 60;
  for (int i = 0; i < kFrames; ++i) {
    ContactLoads loads = body.At(i * kMadeStepS);
    loads.feet[0].cells[0].load_n *= 1.01;
    loads.feet[1].cells[3].load_n *= 0.99;
    const double error = best.Advance(loads).p_WC_m.z() - body.com_m(i * kMadeStepS).z();
    sum += error * error;
  }
  EXPECT_LT(std::sqrt(sum / kFrames), 0.05);
}

TEST(BestEstimator, LagMakesTheHorizontalPlaceBetter) {
  double rms[2] = {0, 0};
  for (const int late : {0, 1}) {
    MadeBody body;
    body.com_m = [](double t) {
      return Eigen::Vector3d(0.03 * Ramp(t) * std::sin(3.1 * t), 0.05 * Ramp(t) * std::sin(4 * t),
                             kMadeHeightM);
    };
    BestConfig config;
    config.lag_s = late * 0.2;
    BestEstimator best(config, {}, body.Calibrate(), kMadeStepS);
    for (int i = 0; i < 1800; ++i) {
      const double t = i * kMadeStepS;
      const Estimate& now = best.Advance(body.At(t));
      if (i > 120) rms[late] += (now.p_WC_m - body.com_m(t - now.lag_s)).head<2>().squaredNorm();
    }
  }
  EXPECT_LT(rms[1], 0.6 * rms[0]);
}

TEST(BestEstimator, PassesOverAPostureThatIsNotOne) {
  MadeBody body;
  BestEstimator best({}, {}, body.Calibrate(), kMadeStepS);
  const Eigen::Vector3d before_m = best.Advance(body.At(0)).p_WC_m;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(best.SeePosture(nan, {0, 0, 1}).p_WC_m, before_m);
  EXPECT_EQ(best.SeePosture(0, {nan, 0, 1}).p_WC_m, before_m);
  EXPECT_EQ(best.SeePosture(0, {0, 0, nan}).p_WC_m, before_m);
  EXPECT_NE(best.SeePosture(0.1, {0, 0.1, 1.1}).p_WC_m, before_m);
  ContactLoads lost = body.At(kMadeStepS);
  lost.feet[0].valid = false;
  const Eigen::Vector3d coasted_m = best.Advance(lost).p_WC_m;
  EXPECT_EQ(best.SeePosture(0.1, {0, 0.1, 1.1}).p_WC_m, coasted_m);
}

TEST(BestEstimator, IsFiniteAndSaysSoWhenTheSourceIsLostOrMad) {
  MadeBody body;
  BestEstimator best({}, {}, body.Calibrate(), kMadeStepS);
  const double before = best.Advance(body.At(0)).position_variance_m2.z();
  for (int i = 1; i < 300; ++i) {
    ContactLoads loads = body.At(i * kMadeStepS);
    if (i % 3 == 0) loads.feet[0].valid = false;
    if (i % 3 == 1) loads.feet[1].cells[2].load_n = std::numeric_limits<double>::quiet_NaN();
    if (i % 3 == 2) loads.feet[0].cells[1].p_WS_m.x() = std::numeric_limits<double>::infinity();
    const Estimate& now = best.Advance(loads);
    EXPECT_FALSE(now.valid);
    ASSERT_TRUE(Finite(now)) << i;
  }
  EXPECT_GT(best.estimate().position_variance_m2.z(), 10 * before);
  EXPECT_EQ(best.estimate().resets, 0u);
  const Estimate& back = best.Advance(body.At(6));
  EXPECT_TRUE(back.valid);
  EXPECT_EQ(back.resets, 1u);
  EXPECT_NEAR(back.p_WC_m.z(), 1.0, 0.02);
  EXPECT_FALSE(back.trusted) << "it may have come back at any height";
}

TEST(BestEstimator, StaysFiniteUnderAnyLoads) {
  MadeBody body;
  BestEstimator best({}, {}, body.Calibrate(), kMadeStepS);
  noise::Random random(11);
  for (int i = 0; i < 20000; ++i) {
    ContactLoads loads = body.At(i * kMadeStepS);
    const double size = std::pow(10, random.Uniform(-3, 5));
    for (FootLoads& foot : loads.feet)
      for (Cell& cell : foot.cells) cell.load_n = size * random.Uniform(-1, 1);
    ASSERT_TRUE(Finite(best.Advance(loads))) << i;
  }
}

TEST(BestEstimator, FollowsAFootThatIsPutElsewhere) {
  MadeBody body;
  BestEstimator best({}, {}, body.Calibrate(), kMadeStepS);
  const Eigen::Vector3d moved(0.12, -0.03, 0);
  for (int i = 0; i < 240; ++i) {
    ContactLoads loads = body.At(i * kMadeStepS);
    FootLoads& right = loads.feet[1];
    // Off for half a second, then 12 cm ahead: the same cells feel the load further in front.
    if (i >= 120 && i < 150)
      for (Cell& cell : right.cells) cell.load_n = 0;
    if (i >= 150)
      for (Cell& cell : right.cells) {
        const double front = cell.p_WS_m.x() > 0 ? 1 : -1;
        const double side = cell.p_WS_m.y() > -kBoardYM ? 1 : -1;
        cell.load_n *=
            (1 + front * moved.x() / kHalfLengthM) * (1 + side * moved.y() / kHalfWidthM);
      }
    best.Advance(loads);
    if (i == 140) {
      EXPECT_FALSE(best.estimate().feet[1].contact);
      EXPECT_NEAR(best.estimate().feet[1].airborne_s, 20 * kMadeStepS, 0.02);
    }
    if (i == 150) {
      EXPECT_TRUE(best.estimate().feet[1].contact);
    }
  }
  const FootEstimate& foot = best.estimate().feet[1];
  // The sole's COP may be up to 15 cm ahead of the rest point: a standing foot tells its place
  // over the time that its COP wanders, so most of the way, not all, is found. 2.5 cm of it are
  // FootPlaceConfig::ahead_m: this person presses where one in the T-pose does.
  EXPECT_NEAR(foot.p_WF_m.x(), moved.x(), 0.04);
  EXPECT_NEAR(foot.p_WF_m.y(), -kBoardYM + moved.y(), 0.01);
  EXPECT_LT(std::abs(foot.p_WF_m.x() - moved.x()), 2 * std::sqrt(foot.variance_m2.x()));
}

TEST(FootPlace, AllThatTheCopHasBeenSinceTheLandingBoundsTheFoot) {
  const FootShape shape;
  FootPlace place(shape);
  place.Start(Eigen::Vector3d::Zero());
  const double step_s = 1.0 / 60, place_m = 0.05;
  Pressure pressure{.total_n = 400, .cop_valid = true};
  for (int i = 0; i < 30; ++i) place.Advance({}, false, false, step_s);
  const double toes_m = place_m + (1 - shape.rest_share) * shape.length_m - 0.01;
  const double heel_m = place_m - shape.rest_share * shape.length_m + 0.01;
  for (int i = 0; i < 300; ++i) {
    // Five seconds on the toes, but for one visit to the heel.
    pressure.p_WP_m.x() = i >= 60 && i < 64 ? heel_m : toes_m;
    place.Advance(pressure, true, i == 0, step_s);
    // 1 cm to the sole's edge, 5 mm of the COP's own error, and 1 mm/s that the bounds loosen by.
    if (i > 64) {
      ASSERT_NEAR(place.position_m().x(), place_m, 0.015 + 0.001 * (i + 1) * step_s + 1e-6) << i;
    }
  }
  EXPECT_LT(std::sqrt(place.variance_m2().x()), 0.02);
}

}  // namespace
}  // namespace footing::momentum
