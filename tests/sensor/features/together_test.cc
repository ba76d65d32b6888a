#include "daemon/sensor/features/together.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/base/units.h"
#include "tests/sensor/features/chain.h"

/// Hands that swing together are seen before their period is.
namespace footing::features {
namespace {

using wrists::HandMotion;
using wrists::Segment;
using wrists::Shape;

/// 3 s of sines of 1 Hz, from `angle_rad` on.
SampleGrid Sine(double angle_rad, double amplitude_mps2) {
  SampleGrid grid{Config{}};
  for (int i = 0; i < 300; ++i) {
    stream::MotionSample sample;
    sample.sampled_ns = i * kGridStepNs;
    sample.specific_force_mps2 = sample.filtered_mps2 =
        Eigen::Vector3d(0, amplitude_mps2 * std::sin(angle_rad + 2 * kPi * i * kGridStepS), -9.81);
    grid.Add(sample);
  }
  return grid;
}

/// Of controllers that lie alike in both hands.
double Correlation(const SampleGrid& left, const SampleGrid& right, double span_s) {
  return CorrelationNow(left, right, Eigen::Matrix3d::Identity(), span_s);
}

TEST(CorrelationNow, IsOneTogetherAndMinusOneInTurnsOverAnySpan) {
  for (const double angle_rad : {0.0, 0.7, 1.6, 2.5}) {
    const SampleGrid left = Sine(angle_rad, 5);
    for (const double span_s : {0.25, 0.4, 1.0, 2.1}) {
      EXPECT_NEAR(Correlation(left, Sine(angle_rad, 8), span_s), 1, 1e-9) << span_s;
      EXPECT_NEAR(Correlation(left, Sine(angle_rad + kPi, 3), span_s), -1, 1e-9) << span_s;
    }
    // A quarter of a cycle apart, over a whole one: neither.
    EXPECT_NEAR(Correlation(left, Sine(angle_rad + kPi / 2, 5), 0.99), 0, 1e-9);
  }
}

TEST(CorrelationNow, IsZeroWithoutEnoughSamplesOrMotion) {
  EXPECT_EQ(Correlation(Sine(0, 5), Sine(0, 5), 3.5), 0);
  EXPECT_EQ(Correlation(Sine(0, 5), Sine(0, 0), 1), 0);
}

/// A run with bent arms, and what comes after it as the arms hang down: 50 degrees lower.
HandMotion AfterARun(double frequency_hz, double phase_rad, double start_angle_rad) {
  const Segment run{3, 1.9, kPi, 8, 0, DegreesToRadians(-20)};
  const Segment after{3, frequency_hz, phase_rad, 9, 0, DegreesToRadians(-70)};
  return HandMotion({run, after}, Shape(), 0.4, start_angle_rad);
}

/// As the interfaces read it.
bool ShowsTogether(const stream::RigFeatures& rig) {
  const stream::PairFeatures& pair = rig.pairs[0];
  return pair.phase_valid && !pair.phase_held && std::abs(pair.phase_rad) < kPi / 2;
}

class AfterARunFrom : public testing::TestWithParam<double> {};  // The hand's angle at the start.

TEST_P(AfterARunFrom, HandsTogetherAreSeenWithinACycleAndAHalf) {
  for (const double frequency_hz : {1.4, 2.4}) {
    double seen_s = INFINITY;
    for (const auto& instant : RunChain(AfterARun(frequency_hz, 0, GetParam()))) {
      if (instant.t_s > 3 && ShowsTogether(instant.rig)) seen_s = std::min(seen_s, instant.t_s - 3);
    }
    EXPECT_LT(seen_s, 1.5 / 1.9) << frequency_hz;
  }
}

TEST_P(AfterARunFrom, HandsInTurnsAreNeverTogether) {
  for (const double frequency_hz : {0.9, 1.4, 2.4, 3.0}) {
    for (const auto& instant : RunChain(AfterARun(frequency_hz, kPi + 0.3, GetParam()))) {
      EXPECT_FALSE(ShowsTogether(instant.rig)) << frequency_hz << " Hz, " << instant.t_s << " s";
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Angles, AfterARunFrom, testing::Values(0.0, 1.3, 2.9, 4.6));

}  // namespace
}  // namespace footing::features
