#include "daemon/sensor/features/kalman_filter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "common/base/units.h"
#include "common/virtual/devices/noise.h"

namespace footing::signal {
namespace {

constexpr std::int64_t kStepNs = 10'000'000;
const Eigen::Vector3d kRest(0, 0, -9.81);

TEST(KalmanFilter, TheFirstSamplePassesAsItIs) {
  KalmanFilter filter;
  EXPECT_EQ(filter.Advance(5, kRest), kRest);
}

TEST(KalmanFilter, AConstantForceStaysAsItIs) {
  KalmanFilter filter;
  for (int i = 0; i < 500; ++i) {
    EXPECT_LT((filter.Advance(i * kStepNs, kRest) - kRest).norm(), 1e-12);
  }
}

/// Noise power after the filter over that before, at rest.
double NoiseLeft(const KalmanConfig& config) {
  KalmanFilter filter(config);
  noise::Random random(3);
  double raw = 0;
  double filtered = 0;
  for (int i = 0; i < 3000; ++i) {
    const Eigen::Vector3d noise =
        0.1 * Eigen::Vector3d(random.Normal(), random.Normal(), random.Normal());
    const Eigen::Vector3d out = filter.Advance(i * kStepNs, kRest + noise);
    raw += noise.squaredNorm();
    filtered += (out - kRest).squaredNorm();
  }
  return filtered / raw;
}

TEST(KalmanFilter, NoiseShrinksAtRest) { EXPECT_LT(NoiseLeft({}), 0.8); }

TEST(KalmanFilter, ALevelThatChangesAsMuchAsItsNoiseGetsTheGoldenRatioForAGain) {
  KalmanConfig config;
  config.model = KalmanConfig::Model::kConstantLevel;
  config.sensor_noise_mps2 = 0.1;
  config.quantum_mps2 = 0;
  config.level_change_mps3 = 0.1 / 0.01;  // 0.1 m/s² a sample: q = r.
  // P = r (1 + sqrt 5) / 2 before the correction, so k = P / (P + r) = 0.618; white noise through
  // x += k (z - x) keeps k / (2 - k) = 0.447 of its power.
  EXPECT_NEAR(NoiseLeft(config), 0.447, 0.03);
}

TEST(KalmanFilter, ASwingOfThreeHertzKeepsItsSizeAndPlace) {
  KalmanFilter filter;
  double most = 0;
  for (int i = 0; i < 400; ++i) {
    const double angle = 2 * kPi * 3 * i * 0.01;
    const double truth = 10 * std::sin(angle);
    const double out = filter.Advance(i * kStepNs, kRest + Eigen::Vector3d(0, truth, 0)).y();
    if (i > 100) most = std::max(most, std::abs(out - truth));
  }
  // One sample of delay would be 10 sin(2 pi 3 0.01) = 1.87 m/s².
  EXPECT_LT(most, 1.0);
}

TEST(KalmanFilter, TheSlopeTrailsARampLessThanTheLevelAlone) {
  const auto lag = [](KalmanConfig::Model model) {
    KalmanConfig config;
    config.model = model;
    KalmanFilter filter(config);
    double out = 0;
    for (int i = 0; i <= 300; ++i) out = filter.Advance(i * kStepNs, {0.2 * i, 0, 0}).x();
    return 0.2 * 300 - out;
  };
  EXPECT_LT(std::abs(lag(KalmanConfig::Model::kConstantSlope)), 1e-6);
  EXPECT_GT(lag(KalmanConfig::Model::kConstantLevel), 0.01);
}

TEST(KalmanFilter, APauseOrAClockThatJumpsBackStartsAnew) {
  KalmanFilter filter;
  for (int i = 0; i < 50; ++i) filter.Advance(i * kStepNs, kRest);
  const Eigen::Vector3d other(9.81, 0, 0);
  EXPECT_EQ(filter.Advance(50 * kStepNs + kNanosecondsPerSecond, other), other);
  EXPECT_EQ(filter.Advance(0, kRest), kRest);
}

TEST(KalmanFilter, WhatIsNotFiniteAndWhatIsNotNewerChangesNothing) {
  KalmanFilter filter;
  filter.Advance(0, kRest);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(filter.Advance(kStepNs, {nan, 0, 0}), kRest);
  EXPECT_EQ(filter.Advance(0, {5, 5, 5}), kRest);
}

TEST(KalmanFilter, ACopyContinuesBitForBit) {
  KalmanFilter filter;
  noise::Random random(9);
  for (int i = 0; i < 20; ++i) filter.Advance(i * kStepNs, {random.Normal(), 0, 0});
  KalmanFilter copy = filter;
  for (int i = 20; i < 40; ++i) {
    const Eigen::Vector3d sample(random.Normal(), 1, 2);
    EXPECT_EQ(filter.Advance(i * kStepNs, sample), copy.Advance(i * kStepNs, sample));
  }
}

}  // namespace
}  // namespace footing::signal
