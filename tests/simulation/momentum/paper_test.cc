#include <gtest/gtest.h>

#include <cmath>

#include "daemon/simulation/momentum/paper_estimator.h"
#include "tests/simulation/momentum/made_body.h"

namespace footing::momentum {
namespace {

constexpr double kPaperWeightN = kMadeMassKg * kStandardGravityMps2;

TEST(PaperVertical, IntegratesAForceTwice) {
  DecayRule off;
  off.enabled = false;
  PaperVertical height(off, {1e6, 1e-3}, kMadeMassKg, 1.0);  // A filter that believes the load.
  for (int i = 0; i < 60; ++i) height.Advance(kPaperWeightN + 70, kMadeStepS);
  EXPECT_NEAR(height.velocity_mps(), 1.0, 1e-6);  // 70 N on 70 kg for one second.
  EXPECT_NEAR(height.height_m(), 1.5, 0.01 + 0.5 * kMadeStepS);
}

TEST(PaperVertical, DecayTakesAwayWhatOneOutlierLeft) {
  for (const bool decay : {false, true}) {
    DecayRule rule;
    rule.enabled = decay;
    PaperVertical height(rule, {1e6, 1e-3}, kMadeMassKg, 1.0);
    for (int i = 0; i < 600; ++i) {
      const double outlier = i == 100 ? 10 * kMadeMassKg : 0;  // 10 m/s² for one frame.
      height.Advance(kPaperWeightN + outlier, kMadeStepS);
    }
    // Without it 1/6 m/s go on for 500 frames; with it for 0.05 s and the time constant of 0.5 s.
    if (decay) {
      EXPECT_NEAR(height.height_m(), 1.0 + 10 * kMadeStepS * (0.05 + 0.5), 0.01);
    } else {
      EXPECT_NEAR(height.height_m(), 1.0 + 500 * kMadeStepS * 10 * kMadeStepS, 0.02);
    }
  }
}

TEST(PaperVertical, DecaysInSecondsAtAnyRateOfFrames) {
  const auto rises_m = [](double rate_hz) {
    PaperVertical height(DecayRule{}, {1e6, 1e-3}, kMadeMassKg, 1.0);
    const auto frames = static_cast<int>(10 * rate_hz);
    for (int i = 0; i < frames; ++i)  // 1/6 m/s in one frame.
      height.Advance(kPaperWeightN + (i == 0 ? kMadeMassKg * rate_hz / 6 : 0), 1 / rate_hz);
    return height.height_m() - 1;
  };
  EXPECT_NEAR(rises_m(60), rises_m(120), 0.004);  // Half as much at 120 Hz if it were by frames.
}

TEST(AngularMomentumRate, IsTheMomentOfBothFeetAboutTheCentreOfMass) {
  std::array<Pressure, kFeet> feet;
  feet[0] = {300, true, {0.1, 0.2, 0}};
  feet[1] = {400, true, {-0.05, -0.15, 0}};
  const Eigen::Vector3d rate = AngularMomentumRate(feet, {0, 0, 1}, {0.7, 0}, 100);
  // x: y F_z: 0.2 300 - 0.15 400 = 0; y: z F_x - x F_z = -1 * 70 - (0.1 300 - 0.05 400) = -80;
  // z: -y F_x = -(0.2 * 30 - 0.15 * 40) = 0.
  EXPECT_NEAR(rate.x(), 0, 1e-9);
  EXPECT_NEAR(rate.y(), -80, 1e-9);
  EXPECT_NEAR(rate.z(), 0, 1e-9);
}

TEST(AngularMomentum, DecaysWhenItsRateIsZero) {
  AngularMomentum momentum({true, 3, 0.05, 0.15});
  for (int i = 0; i < 60; ++i) momentum.Advance({0, 10, 0}, 1, kMadeStepS);
  EXPECT_NEAR(momentum.value().y(), 10, 1e-9);
  for (int i = 0; i < 60; ++i) momentum.Advance({0, 0, 0}, 1, kMadeStepS);
  EXPECT_LT(momentum.value().y(), 0.1);
}

TEST(PaperFoot, IgnoresAWanderingCopAndLiftsAfterZeroPressure) {
  PaperFoot foot({}, {0, 0.16, 0});
  for (int i = 0; i < 60; ++i)
    foot.Advance({300, true, {0.1 * std::sin(0.5 * i), 0.16, 0}}, kMadeStepS);
  EXPECT_NEAR(foot.position_m().x(), 0, 1e-9);
  for (int i = 0; i < 60; ++i) foot.Advance({0, false, {}}, kMadeStepS);
  EXPECT_NEAR(foot.position_m().z(), 0.15, 1e-9);
  foot.Advance({300, true, {0.08, 0.2, 0}}, kMadeStepS);
  EXPECT_GT(foot.position_m().z(), 0.1);  // It glides, it does not jump.
  for (int i = 0; i < 60; ++i) foot.Advance({300, true, {0.08, 0.2, 0}}, kMadeStepS);
  EXPECT_NEAR((foot.position_m() - Eigen::Vector3d(0.08, 0.2, 0)).norm(), 0, 1e-9);
}

TEST(PaperFoot, LandsWhereTheCopSettlesAndThenStays) {
  PaperFoot foot({}, {0, 0.16, 0});
  for (int i = 0; i < 60; ++i) foot.Advance({0, false, {}}, kMadeStepS);
  // The heel touches first; within 0.2 s the load has rolled on to the middle of the sole.
  for (int i = 0; i < 40; ++i)
    foot.Advance({300, true, {std::min(0.1, 0.5 * i * kMadeStepS), 0.16, 0}}, kMadeStepS);
  EXPECT_NEAR((foot.position_m() - Eigen::Vector3d(0.1, 0.16, 0)).norm(), 0, 1e-9);
  // Half a second on, a COP that moves is none of its business.
  for (int i = 0; i < 60; ++i)
    foot.Advance({300, true, {0.1 + 0.08 * std::sin(0.5 * i), 0.16, 0}}, kMadeStepS);
  EXPECT_NEAR(foot.position_m().x(), 0.1, 0.02);
}

TEST(PaperEstimator, TakesThePredictedCentreOfMassAndStaysFinite) {
  MadeBody body;
  PaperEstimator paper({}, {}, body.Calibrate(), kMadeStepS);
  const Estimate& still = paper.Advance(body.At(0), Eigen::Vector2d(0.02, -0.01));
  EXPECT_EQ(still.p_WC_m.x(), 0.02);
  EXPECT_NEAR(still.p_WC_m.z(), 1.0, 1e-6);
  ContactLoads bad = body.At(0.1);
  bad.feet[0].cells[0].load_n = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(paper.Advance(bad, std::nullopt).valid);
  EXPECT_TRUE(paper.estimate().p_WC_m.allFinite());
  EXPECT_TRUE(paper.Advance(body.At(0.2), std::nullopt).valid);
}

}  // namespace
}  // namespace footing::momentum
