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

TEST(KalmanFilter, NoiseShrinksAtRest) {
  KalmanFilter filter;
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
  EXPECT_LT(filtered / raw, 0.8);  // Power.
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

TEST(KalmanFilter, DoesNotTrailARamp) {
  KalmanFilter filter;
  double out = 0;
  for (int i = 0; i <= 300; ++i) out = filter.Advance(i * kStepNs, {0.2 * i, 0, 0}).x();
  EXPECT_NEAR(out, 0.2 * 300, 1e-6);
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
