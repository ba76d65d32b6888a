#include "daemon/simulation/momentum/cell_play.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "daemon/simulation/momentum/best_estimator.h"
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
  config.height_posture = LearnedHeightPosture();
  BestEstimator best(config, {}, calibration.result(), kMadeStepS);
  double square_m2 = 0;
  constexpr int kFrames = 30 * 60;
  for (int i = 0; i < kFrames; ++i) {
    const double t = i * kMadeStepS, height_m = body.com_m(t).z();
    best.Advance(read(t));
    const double posture_m = kMadeHeightM + 0.2 * (height_m - kMadeHeightM);
    square_m2 += std::pow(best.SeePosture(0, {0, 0, posture_m}).p_WC_m.z() - height_m, 2);
  }
  return std::sqrt(square_m2 / kFrames);
}

TEST(BestEstimator, FindsHowMuchPlayTheCellsHave) {
  EXPECT_LT(HeightError(0), 0.04);
  EXPECT_LT(HeightError(5), 0.1);  // Without a filter for it 0.127.
}

}  // namespace
}  // namespace footing::momentum
