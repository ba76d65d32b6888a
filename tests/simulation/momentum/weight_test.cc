#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "daemon/simulation/momentum/best_estimator.h"
#include "tests/simulation/momentum/made_body.h"

// Weights that are wrong or change, postures, and landings.
namespace footing::momentum {
namespace {

// Root mean square error of the height over a minute in which the cells tell `share` of what they
// told in the T-pose.
double HeightErrorAfter(MadeBody body, double share, double& mass_kg) {
  BestEstimator best({}, {}, body.Calibrate(), kMadeStepS);
  double sum = 0;
  constexpr int kFrames = 3600;
  for (int i = 0; i < kFrames; ++i) {
    ContactLoads loads = body.At(i * kMadeStepS);
    for (FootLoads& foot : loads.feet)
      for (Cell& cell : foot.cells) cell.load_n *= share;
    const double error = best.Advance(loads).p_WC_m.z() - body.com_m(i * kMadeStepS).z();
    sum += error * error;
  }
  mass_kg = best.mass_kg();
  return std::sqrt(sum / kFrames);
}

TEST(BestEstimator, FindsAWeightThatTheTPoseHadWrong) {
  for (const double share : {0.98, 1.02, 0.95}) {
    double mass_kg = 0;
    EXPECT_LT(HeightErrorAfter(Squatter(), share, mass_kg), 0.03) << share;
    EXPECT_NEAR(mass_kg, share * kMadeMassKg, 0.002 * kMadeMassKg) << share;
  }
}

TEST(BestEstimator, FindsTheWeightOfOneWhoNeverStandsStill) {
  MadeBody body;
  body.noise_n = 0.5;
  body.com_m = [](double t) {
    return Eigen::Vector3d(0, 0, kMadeHeightM - 0.08 * Ramp(t) * (1 - std::cos(2 * kPi * 0.8 * t)));
  };
  double mass_kg = 0;
  EXPECT_LT(HeightErrorAfter(body, 0.98, mass_kg), 0.10);
  EXPECT_NEAR(mass_kg, 0.98 * kMadeMassKg, 0.003 * kMadeMassKg);
}

TEST(BestEstimator, KeepsTheWeightThatTheTPoseHadRight) {
  double mass_kg = 0;
  EXPECT_LT(HeightErrorAfter(Squatter(), 1, mass_kg), 0.03);
  EXPECT_EQ(mass_kg, Squatter().Calibrate().mass_kg);
}

TEST(BestEstimator, KeepsTheWeightThatItFoundWhenTheBodyStepsOff) {
  MadeBody body = Squatter();
  BestEstimator best({}, {}, body.Calibrate(), kMadeStepS);
  for (int i = 0; i < 3600; ++i) {
    ContactLoads loads = body.At(i * kMadeStepS);
    const bool away = i >= 3000 && i < 3120;
    for (FootLoads& foot : loads.feet)
      for (Cell& cell : foot.cells) cell.load_n *= away ? 0 : 0.95;
    best.Advance(loads);
    if (i > 3120) {
      EXPECT_NEAR(best.mass_kg(), 0.95 * kMadeMassKg, 0.003 * kMadeMassKg) << i;
    }
  }
  EXPECT_EQ(best.estimate().resets, 1u);
}

// A posture that is wrong by a first-order process along each axis.
class WrongPosture {
 public:
  Eigen::Vector3d Of(const Eigen::Vector3d& com_m) {
    const Eigen::Vector3d time_s(0.25, 0.25, 3), spread_m(0.03, 0.03, 0.06);
    for (int i = 0; i < 3; ++i) {
      const double keep = std::exp(-kMadeStepS / time_s(i));
      error_m_(i) =
          keep * error_m_(i) + spread_m(i) * std::sqrt(1 - keep * keep) * random_.Normal();
    }
    return com_m + error_m_;
  }

 private:
  noise::Random random_{8};
  Eigen::Vector3d error_m_ = Eigen::Vector3d::Zero();
};

TEST(BestEstimator, APostureTellsWhatLoadsCannot) {
  const auto com_m = [](double t) {
    return Eigen::Vector3d(0, 0.05 * Ramp(t) * std::sin(4 * t) * std::sin(0.7 * t),
                           kMadeHeightM - 0.1 * Ramp(t) * (1 + std::sin(2.3 * t)));
  };
  Eigen::Vector3d rms[2] = {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  for (const int seen : {0, 1}) {
    MadeBody body;
    body.com_m = com_m;
    BestEstimator best({}, {}, body.Calibrate(), kMadeStepS);
    WrongPosture posture;
    for (int i = 0; i < 3600; ++i) {
      const double t = i * kMadeStepS;
      Eigen::Vector3d told_m = best.Advance(body.At(t)).p_WC_m;
      const Eigen::Vector3d seen_m = posture.Of(com_m(t));
      if (seen == 1) told_m = best.SeePosture(seen_m.y(), seen_m).p_WC_m;
      rms[seen] += (told_m - com_m(t)).cwiseAbs2() / 3600;
    }
    rms[seen] = rms[seen].cwiseSqrt();
  }
  EXPECT_LT(rms[1].y(), 0.85 * rms[0].y());
  EXPECT_NEAR(rms[1].x(), rms[0].x(), 1e-3);
  EXPECT_LT(rms[1].z(), rms[0].z() + 1e-3);
}

// Errors of the height while the posture is seen, from the time `from_s` on: rms, and the greatest
// of frames that are trusted. From `change_s` on the cells measure `share` of the load.
struct HeightErrors {
  double rms_m = 0, greatest_trusted_m = 0, trusted_share = 0;
};
HeightErrors ErrorsAfterChange(double share, double change_s, double from_s) {
  MadeBody body = Squatter();
  BestConfig config;
  config.height_posture = LearnedHeightPosture();
  BestEstimator best(config, {}, body.Calibrate(), kMadeStepS);
  WrongPosture posture;
  HeightErrors errors;
  int count = 0;
  for (int i = 0; i < 30 * 60; ++i) {
    const double t = i * kMadeStepS;
    ContactLoads loads = body.At(t);
    for (FootLoads& foot : loads.feet) {
      for (Cell& cell : foot.cells) cell.load_n *= t < change_s ? 1 : share;
    }
    best.Advance(loads);
    const Eigen::Vector3d seen_m = posture.Of(body.com_m(t));
    const Estimate& now = best.SeePosture(seen_m.y(), seen_m);
    if (t < from_s) continue;
    const double error = now.p_WC_m.z() - body.com_m(t).z();
    ++count;
    errors.rms_m += error * error;
    errors.trusted_share += now.trusted ? 1 : 0;
    if (now.trusted)
      errors.greatest_trusted_m = std::max(errors.greatest_trusted_m, std::abs(error));
  }
  errors.rms_m = std::sqrt(errors.rms_m / count);
  errors.trusted_share /= count;
  return errors;
}

TEST(BestEstimator, AWeightThatChangesInMidMovementDoesNotCarryTheHeightAway) {
  for (const double share : {0.95, 0.99, 1.01, 1.05}) {
    const HeightErrors errors = ErrorsAfterChange(share, 5.3, 6.3);
    EXPECT_LT(errors.rms_m, 0.15) << share;
    EXPECT_LT(errors.greatest_trusted_m, 0.55) << share;
    EXPECT_GT(errors.trusted_share, 0.9) << share;
  }
}

// Greatest error of the height of a body that moves by `height_m` over the T-pose, seen by a
// posture that has half of a crouch.
double GreatestHeightError(double (*height_m)(double)) {
  MadeBody body;
  body.noise_n = 0.5;
  body.com_m = [height_m](double t) { return Eigen::Vector3d(0, 0, kMadeHeightM + height_m(t)); };
  BestConfig config;
  config.height_posture = LearnedHeightPosture();
  BestEstimator best(config, {}, body.Calibrate(), kMadeStepS);
  double greatest_m = 0;
  for (int i = 0; i < 8 * 60; ++i) {
    const double t = i * kMadeStepS, now_m = height_m(t);
    best.Advance(body.At(t));
    const double told_m =
        best.SeePosture(0, {0, 0, kMadeHeightM + std::max(now_m, 0.5 * now_m)}).p_WC_m.z();
    greatest_m = std::max(greatest_m, std::abs(told_m - kMadeHeightM - now_m));
  }
  return greatest_m;
}

// The integral of Ramp.
double RampedRise(double t) {
  if (t <= 0) return 0;
  return t >= 1 ? t - 0.5 : t * t * t * t * (2.5 - 3 * t + t * t);
}

TEST(BestEstimator, DoesNotTakeASlowEvenDescentForStillness) {
  // 7 cm down at 5 cm/s, with an acceleration in the first and the last 0.4 s only.
  EXPECT_LT(GreatestHeightError([](double t) {
              return -0.05 * 0.4 * (RampedRise((t - 1) / 0.4) - RampedRise((t - 2.4) / 0.4));
            }),
            0.03);
}

TEST(BestEstimator, FollowsABodyThatRisesOverItsTPose) {
  // A raised knee, or arms over the head.
  EXPECT_LT(GreatestHeightError(
                [](double t) { return 0.08 * Ramp(2 * (t - 1)) * (1 - Ramp(2 * (t - 2.5))); }),
            0.025);
}

TEST(BestEstimator, ComesBackWithinASecondOfALandingThatItDidNotSeeComing) {
  MadeBody body;
  BestConfig config;
  config.height_posture = LearnedHeightPosture();
  BestEstimator best(config, {}, body.Calibrate(), kMadeStepS);
  // Off the cells for three seconds; back on them out of a fall, knees giving way by 15 cm.
  const auto height_m = [](double t) {
    return kMadeHeightM - (t < 3 ? 0 : 0.15 * Ramp(2 * (t - 3)));
  };
  body.com_m = [&](double t) { return Eigen::Vector3d(0, 0, height_m(t)); };
  for (int i = 0; i < 5 * 60; ++i) {
    const double t = i * kMadeStepS;
    ContactLoads loads = body.At(t);
    if (t < 3) {
      for (FootLoads& foot : loads.feet) {
        for (Cell& cell : foot.cells) cell.load_n = 0;
      }
    }
    best.Advance(loads);
    const Estimate& now = best.SeePosture(0, {0, 0, height_m(t) + 0.04});
    if (t > 1.2 && t < 2.9) {
      EXPECT_FALSE(now.valid);
    }
    if (t > 4) {
      EXPECT_TRUE(now.trusted) << t;
      EXPECT_NEAR(now.p_WC_m.z(), height_m(t), 0.14) << t;
    }
  }
  EXPECT_EQ(best.estimate().resets, 1u);
}

TEST(BestEstimator, LandsAfterAShortFlightThatBeganElsewhere) {
  // Out of the T-pose onto a box, unseen, and from it at 2 m/s onto the boards, ahead of where the
  // body stood, knees giving way by 20 cm for a moment. The posture
  // has them half as low.
  constexpr double kLandS = 0.3, kFallMps = 2, kBrakeMps2 = 10;
  constexpr double kStopS = kLandS + kFallMps / kBrakeMps2;
  const auto height_m = [=](double t) {
    const double s = std::min(t, kStopS) - kLandS;
    const double fallen = -kFallMps * s;
    return kMadeHeightM + fallen + 0.5 * s * s * (s < 0 ? -kStandardGravityMps2 : kBrakeMps2) +
           0.2 * Ramp((t - kStopS) / 0.5);
  };
  MadeBody body;
  body.noise_n = 0.5;
  body.com_m = [&](double t) {
    return t < 0.5 * kMadeStepS ? Eigen::Vector3d(0, 0, kMadeHeightM)
                                : Eigen::Vector3d(0.08, 0, height_m(t));
  };
  BestConfig config;
  config.height_posture = LearnedHeightPosture();
  BestEstimator best(config, {}, body.Calibrate(), kMadeStepS);
  for (int i = 0; i < 3 * 60; ++i) {
    const double t = i * kMadeStepS;
    best.Advance(body.At(t));
    const Estimate& now = best.SeePosture(0, {0, 0, 0.5 * (kMadeHeightM + height_m(t))});
    if (t < kLandS + 1) continue;
    EXPECT_TRUE(now.trusted) << t;
    EXPECT_TRUE(now.valid) << t;
    EXPECT_NEAR(now.p_WC_m.z(), height_m(t), 0.1) << t;
    EXPECT_NEAR(now.p_WC_m.x(), 0.08, 0.03) << t;
  }
  EXPECT_EQ(best.estimate().resets, 1u);
}

TEST(BestEstimator, AJumpOnTheSpotIsNoLandingElsewhere) {
  // Knees bend by 15 cm and throw the body up by 20; it lands as it left.
  MadeBody body;
  body.noise_n = 0.5;
  const double up_mps = std::sqrt(2 * kStandardGravityMps2 * 0.2);
  const double flight_s = 2 * up_mps / kStandardGravityMps2;
  const double push_s = 0.3;  // Down by 15 cm, then up to the speed of the lift-off.
  const auto height_m = [=](double t) {
    if (t < 0) return 0.0;
    if (t < 1) return -0.15 * Ramp(t);
    if (t < 1 + push_s) {
      const double u = (t - 1) / push_s;  // A quintic from rest at -15 cm to up_mps at 0.
      const double v = up_mps * push_s, g = -kStandardGravityMps2 * push_s * push_s;
      const double a3 = 1.5 - 4 * v + 0.5 * g, a4 = -2.25 + 7 * v - g, a5 = 0.9 - 3 * v + 0.5 * g;
      return -0.15 + u * u * u * (a3 + u * (a4 + u * a5));
    }
    const double s = t - 1 - push_s;
    if (s < flight_s) return up_mps * s - 0.5 * kStandardGravityMps2 * s * s;
    const double stop_s = 0.2, b = std::min(s - flight_s, stop_s);  // Braked evenly.
    return -up_mps * b + 0.5 * up_mps / stop_s * b * b;
  };
  body.com_m = [&](double t) { return Eigen::Vector3d(0, 0, kMadeHeightM + height_m(t)); };
  BestConfig config;
  config.height_posture = LearnedHeightPosture();
  BestEstimator best(config, {}, body.Calibrate(), kMadeStepS);
  for (int i = 0; i < 3 * 60; ++i) {
    const double t = i * kMadeStepS;
    best.Advance(body.At(t));
    best.SeePosture(0, {0, 0, kMadeHeightM + std::max(0.5 * height_m(t), height_m(t))});
    EXPECT_NEAR(best.estimate().p_WC_m.z(), kMadeHeightM + height_m(t), 0.1) << t;
  }
  EXPECT_EQ(best.estimate().resets, 0u);
}

}  // namespace
}  // namespace footing::momentum
