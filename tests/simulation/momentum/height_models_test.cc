#include <algorithm>
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "daemon/simulation/momentum/best_estimator.h"
#include "daemon/simulation/momentum/cell_play.h"
#include "daemon/simulation/momentum/height_models.h"
#include "tests/simulation/momentum/made_body.h"

// Cells that follow their loads with play.
namespace footing::momentum {
namespace {

constexpr double kNoiseN = 0.5;

/// The play operator of one cell: it reads what it read until the load is `half_width_n` away.
struct PlayOperator {
  double half_width_n = 0;
  bool started = false;
  double reading_n = 0;

  double Advance(double load_n) {
    if (!started) reading_n = load_n;
    started = true;
    reading_n = std::clamp(reading_n, load_n - half_width_n, load_n + half_width_n);
    return reading_n;
  }
};

TEST(CellPlay, FindsTheEndsOfCellsThatMoveAndTheMiddleOfThoseThatRest) {
  CellPlay play(kNoiseN);
  std::array<double, VerticalInput::kGroups> load_n{};
  load_n.fill(80);
  const auto move = [&](double step_n, int frames) {
    double sum = 0;
    for (int i = 0; i < frames; ++i) {
      for (double& load : load_n) load += step_n;
      sum = play.Advance(load_n, kMadeStepS);
    }
    return sum;
  };
  EXPECT_EQ(move(0, 30), 0);
  EXPECT_EQ(move(1, 10), VerticalInput::kGroups);
  EXPECT_NEAR(move(0, 60), 0, 0.01);
  EXPECT_EQ(move(-1, 10), -VerticalInput::kGroups);
}

TEST(CellPlay, ReadsNothingIntoNoise) {
  CellPlay play(kNoiseN);
  noise::Random random(3);
  double square = 0;
  constexpr int kFrames = 6000;
  for (int i = 0; i < kFrames; ++i) {
    std::array<double, VerticalInput::kGroups> load_n{};
    for (double& load : load_n) load = 80 + kNoiseN * random.Normal();
    square += std::pow(play.Advance(load_n, kMadeStepS), 2);
  }
  // A fiftieth of what cells at random ends have.
  EXPECT_LT(square / kFrames, VerticalInput::kGroups / 50.0);
}

/// Error of the height, rms, by cells with that play: squats of 30 cm over 30 s by a body that
/// sways, of which hands and feet show a fifth.
double HeightError(double half_width_n) {
  MadeBody body;
  body.com_m = [](double t) {
    const double phase = t - 4 * std::floor(t / 4);
    const double down = t > 0 ? Ramp(phase - 1) - Ramp(phase - 2.5) : 0;
    return Eigen::Vector3d(0.04 * (down + Ramp(t) * std::sin(3.1 * t)),
                           0.04 * Ramp(t) * std::sin(2.3 * t), kMadeHeightM - 0.3 * down);
  };
  noise::Random random(7);
  std::array<std::array<PlayOperator, 4>, kFeet> cells{};
  const auto read = [&](double t) {
    ContactLoads loads = body.At(t);
    for (std::size_t f = 0; f < kFeet; ++f) {
      for (std::size_t k = 0; k < 4; ++k) {
        cells[f][k].half_width_n = half_width_n;
        double& load = loads.feet[f].cells[k].load_n;
        load = cells[f][k].Advance(load) + kNoiseN * random.Normal();
      }
    }
    return loads;
  };
  TPoseCalibration calibration;
  for (int i = -400; i < 0 && !calibration.complete(); ++i) {
    calibration.Advance(read(i * kMadeStepS), kMadeStepS);
  }
  BestConfig config;
  config.height_posture_m = kLearnedPostureM;
  Estimators best(config, {}, calibration.result(), kMadeStepS);
  double square_m2 = 0;
  constexpr int kFrames = 30 * 60;
  for (int i = 0; i < kFrames; ++i) {
    const double t = i * kMadeStepS, height_m = body.com_m(t).z();
    const double posture_m = kMadeHeightM + 0.2 * (height_m - kMadeHeightM);
    square_m2 += std::pow(best.Advance(read(t), {{0, {0, 0, posture_m}}}).p_WC_m.z() - height_m, 2);
  }
  return std::sqrt(square_m2 / kFrames);
}

TEST(BestEstimator, FindsHowMuchPlayTheCellsHave) {
  EXPECT_LT(HeightError(0), 0.04);
  EXPECT_LT(HeightError(5), 0.1);  // Without a filter for it 0.127.
}

// The greatest height in four seconds in which the cells measure `share` of what they measured in
// the T-pose, and a posture of `posture_m` is seen.
double GreatestHeight(double share, double posture_m) {
  MadeBody body;
  body.noise_n = 0.5;
  const TPose pose = body.Calibrate();
  HeightModels models(pose.mass_kg, kMadeStepS, 0.028, pose.cell_noise_n, kLearnedPostureM);
  models.Start(pose.mean_loads);
  double greatest_m = 0;
  for (int i = 0; i < 4 * 60; ++i) {
    VerticalInput input = Groups(body.At(i * kMadeStepS), 20);
    for (double& load : input.load_n) load *= share;
    models.Advance(input);
    models.SeePosture(posture_m);
    greatest_m = std::max(greatest_m, models.Height(0).mean);
  }
  return greatest_m;
}

TEST(HeightModels, LoadsThatTellTooMuchDoNotLiftABodyOffItsLegs) {
  // 0.5 m/s^2 that nothing corrects moves it by 4 m.
  for (const double posture_m : {0.0, -0.1, -0.3}) {
    EXPECT_LT(GreatestHeight(1.05, posture_m), 0.2) << posture_m;
  }
}

TEST(HeightModels, APostureThatStaysShowsThatTheTPoseWeighedWrong) {
  for (const double share : {0.95, 1.05}) {
    MadeBody body;
    body.noise_n = 0.5;
    body.com_m = [](double t) {  // From side to side, so that its COP never rests.
      return Eigen::Vector3d(0, t > 0 ? 0.03 * std::sin(4.4 * t) : 0, kMadeHeightM);
    };
    const TPose pose = body.Calibrate();
    HeightModels bank(pose.mass_kg, kMadeStepS, 0.028, pose.cell_noise_n, kLearnedPostureM);
    bank.Start(pose.mean_loads);
    double worst_m = 0;
    for (int i = 0; i < 4 * 60; ++i) {
      VerticalInput input = Groups(body.At(i * kMadeStepS), 20);
      for (double& load : input.load_n) load *= share;
      bank.Advance(input);
      bank.SeePosture(0);
      worst_m = std::max(worst_m, std::abs(bank.Height(0).mean));
    }
    // The 0.5 m/s^2 that nobody stands still with move the body 0.5 m within 1.4 s.
    EXPECT_LT(worst_m, 0.2) << share;
  }
}

// Weight found by `seconds` after it changed to `share` of what it was in the T-pose, as the T-pose
// is left and squats of 20 cm begin, of which hands and feet show a half.
double FoundShare(double share, int seconds) {
  MadeBody body;
  body.noise_n = 0.5;
  body.com_m = [](double t) {
    const double down = Ramp(t - 1) * (1 - std::cos(2 * t)) / 2, sway_m = 0.02 * Ramp(t - 0.5);
    return Eigen::Vector3d(0, sway_m * std::sin(3.1 * t), kMadeHeightM - 0.2 * down);
  };
  const TPose pose = body.Calibrate();
  HeightModels bank(pose.mass_kg, kMadeStepS, 0.028, pose.cell_noise_n, kLearnedPostureM);
  bank.Start(pose.mean_loads);
  for (int i = 0; i < (1 + seconds) * 60; ++i) {
    const double t = i * kMadeStepS;
    VerticalInput input = Groups(body.At(t), 20);
    for (double& load : input.load_n) load *= t < 1 ? 1 : share;
    bank.Advance(input);
    bank.SeePosture(0.5 * (body.com_m(t).z() - kMadeHeightM) - 0.03 * Ramp(2 * (t - 0.5)));
  }
  return bank.mass_kg() / pose.mass_kg;
}

TEST(HeightModels, FindsAWeightThatChangesWhenTheTPoseIsLeft) {
  // By a filter that keeps the weight of the T-pose, 1 after ten seconds, too.
  EXPECT_NEAR(FoundShare(0.95, 5), 0.95, 0.015);
}

// Root mean square error of the height from the fourth of six squats of 30 cm on, every four
// seconds, of which hands and feet show a tenth. The cells measure `share` of what they measured in
// the T-pose, and `extra` of the weight more while the body is low.
double LaterSquatsError(double share, double extra) {
  MadeBody body;
  body.noise_n = 0.5;
  body.com_m = [](double t) {
    constexpr double kDownS = 1.2, kSwayM = 0.01;
    const double phase = t - 4 * std::floor(t / 4), sway_m = kSwayM * Ramp(t);
    const double down =
        t > 0 ? Ramp((phase - 1) / kDownS) - Ramp((phase - 1 - kDownS) / kDownS) : 0;
    return Eigen::Vector3d(0.03 * down + sway_m * std::sin(3.1 * t), sway_m * std::sin(2.3 * t),
                           kMadeHeightM - 0.3 * down);
  };
  const TPose pose = body.Calibrate();
  HeightModels bank(pose.mass_kg, kMadeStepS, 0.028, pose.cell_noise_n, kLearnedPostureM);
  bank.Start(pose.mean_loads);
  double square_m2 = 0;
  constexpr int kFrom = 12 * 60, kFrames = 24 * 60;
  for (int i = 0; i < kFrames; ++i) {
    const double t = i * kMadeStepS, height_m = body.com_m(t).z() - kMadeHeightM;
    VerticalInput input = Groups(body.At(t), 20);
    for (double& load : input.load_n) load *= share + (height_m < -0.15 ? extra : 0);
    bank.Advance(input);
    bank.SeePosture(0.1 * height_m);
    if (i >= kFrom) square_m2 += std::pow(bank.Height(0).mean - height_m, 2);
  }
  return std::sqrt(square_m2 / (kFrames - kFrom));
}

TEST(HeightModels, SquatsThatEndWhereTheyBeganShowThatTheLoadsAreRight) {
  // By filters that correct a squat by a posture that does not show it, 0.16.
  EXPECT_LT(LaterSquatsError(1, 0), 0.02);
  EXPECT_LT(LaterSquatsError(1.002, 0), 0.02);
}

TEST(HeightModels, SquatsThatEndElsewhereByTheLoadsLeaveTheHeightToThePosture) {
  // 0.3 m/s^2 for a second: by the loads alone half a metre at the end of each.
  for (const double extra : {-0.03, 0.03}) EXPECT_LT(LaterSquatsError(1, extra), 0.25) << extra;
}

TEST(HeightModels, StayFiniteWhateverIsMeasured) {
  noise::Random random(1);
  const auto chance = [&](double share) { return random.Uniform() < share; };
  for (int trial = 0; trial < 12; ++trial) {
    HeightModels models(kMadeMassKg, kMadeStepS, 0.028, 0.5, trial % 3 > 0 ? kLearnedPostureM : 0);
    models.KeepLag(trial % 2 > 0 ? 12 : 0);
    VerticalInput input;
    input.load_n.fill(kMadeMassKg * 9.8 / VerticalInput::kGroups);
    models.Start(input);
    for (int i = 0; i < 600; ++i) {
      VerticalInput now = input;
      for (double& load : now.load_n) {
        if (chance(0.1)) load *= 4 * random.Uniform();
        if (chance(0.02)) load = chance(0.5) ? 0 : 1e6 * random.Uniform();
      }
      now.cop_valid = chance(0.8);
      now.cop_m = {random.Uniform(), 10 * random.Uniform()};
      if (chance(0.003)) models.Land();
      if (chance(0.003)) models.Reappear();
      if (chance(0.05)) {
        models.Coast();
      } else {
        models.Advance(now);
      }
      if (chance(0.7)) models.SeePosture(chance(0.02) ? 1e3 : 0.5 * random.Uniform() - 0.4);
      const auto height = models.Height(trial % 2 > 0 ? 7 : 0);
      ASSERT_TRUE(std::isfinite(height.mean) && std::isfinite(height.variance)) << i;
      ASSERT_GE(height.variance, 0) << i;
      ASSERT_TRUE(std::isfinite(models.mass_kg()) && std::isfinite(models.Velocity().mean)) << i;
    }
  }
}

}  // namespace
}  // namespace footing::momentum
