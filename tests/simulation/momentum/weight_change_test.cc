#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "daemon/simulation/momentum/best_estimator.h"
#include "tests/simulation/momentum/made_body.h"

// A weight that changes while the body stands still, as of a person who leans on something or
// carries it in the T-pose and not after it.
namespace footing::momentum {
namespace {

struct AfterChange {
  double height_rms_m = 0;
  double mass_kg = 0;  ///< When the body begins to move.
};

// It stands still in its T-pose until `stand_s`, then squats, of which hands and feet show a tenth.
AfterChange SquatAfterChange(double share, double stand_s) {
  constexpr double kChangeS = 0.2;
  MadeBody body;
  body.noise_n = 0.5;
  body.com_m = [stand_s](double t) {
    const double down = Ramp(t - stand_s) - Ramp(t - stand_s - 1.5);
    return Eigen::Vector3d(0, 0, kMadeHeightM - 0.3 * down);
  };
  BestConfig config;
  config.height_posture = LearnedHeightPosture();
  BestEstimator best(config, {}, body.Calibrate(), kMadeStepS);
  AfterChange after;
  constexpr int kFrames = 300;
  int squatting = 0;
  for (int i = 0; i < kFrames; ++i) {
    const double t = i * kMadeStepS, height_m = body.com_m(t).z();
    ContactLoads loads = body.At(t);
    for (FootLoads& foot : loads.feet) {
      for (Cell& cell : foot.cells) cell.load_n *= t < kChangeS ? 1 : share;
    }
    best.Advance(loads);
    const double posture_m = kMadeHeightM + 0.1 * (height_m - kMadeHeightM);
    const double error_m = best.SeePosture(0, {0, 0, posture_m}).p_WC_m.z() - height_m;
    if (t < stand_s) {
      after.mass_kg = best.mass_kg();
      continue;
    }
    ++squatting;
    after.height_rms_m += error_m * error_m;
  }
  after.height_rms_m = std::sqrt(after.height_rms_m / squatting);
  return after;
}

TEST(BestEstimator, FindsAWeightThatChangesWhileTheBodyStands) {
  for (const double share : {0.95, 0.97, 1.03, 1.05}) {
    const AfterChange after = SquatAfterChange(share, 1.4);
    EXPECT_NEAR(after.mass_kg, share * kMadeMassKg, 0.003 * kMadeMassKg) << share;
    EXPECT_LT(after.height_rms_m, 0.06) << share;
  }
}

TEST(BestEstimator, FindsAWeightThatChangesShortlyBeforeTheTPoseIsLeft) {
  for (const double share : {0.95, 0.97, 1.03, 1.05}) {
    const AfterChange after = SquatAfterChange(share, 0.9);
    EXPECT_NEAR(after.mass_kg, share * kMadeMassKg, 0.003 * kMadeMassKg) << share;
    EXPECT_LT(after.height_rms_m, 0.03) << share;
  }
}

TEST(BestEstimator, AMotionThatBeginsEvenlyIsNoWeight) {
  for (const double mps2 : {-0.14, -0.1, 0.1, 0.14}) {
    MadeBody body;
    body.noise_n = 0.5;
    body.com_m = [mps2](double t) {  // From 1 s on for 0.4 s, then back to rest in the same time.
      constexpr double kS = 0.4;
      const double s = std::clamp(t - 1, 0.0, 2 * kS), left_s = 2 * kS - s;
      const double moved = s < kS ? 0.5 * s * s : kS * kS - 0.5 * left_s * left_s;
      return Eigen::Vector3d(0, 0, kMadeHeightM + mps2 * moved);
    };
    BestConfig config;
    config.height_posture = LearnedHeightPosture();
    const TPose pose = body.Calibrate();
    BestEstimator best(config, {}, pose, kMadeStepS);
    for (int i = 0; i < 180; ++i) {
      const double t = i * kMadeStepS, height_m = body.com_m(t).z();
      best.Advance(body.At(t));
      best.SeePosture(0, {0, 0, kMadeHeightM + 0.3 * (height_m - kMadeHeightM)});
      EXPECT_EQ(best.mass_kg(), pose.mass_kg) << mps2 << " at " << t;
    }
  }
}

TEST(BestEstimator, AFootBesideTheBoardsInTheTPoseIsNoWeight) {
  EXPECT_GT(SquatAfterChange(0.7, 1.4).mass_kg, 0.9 * kMadeMassKg);
}

}  // namespace
}  // namespace footing::momentum
