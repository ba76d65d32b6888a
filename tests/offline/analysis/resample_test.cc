#include <gtest/gtest.h>

#include <cmath>

#include "common/base/units.h"
#include "daemon/offline/analysis/sway.h"

namespace footing::posturography {
namespace {

/// A circle of radius 10 mm at 0.25 Hz over 20 s, at uneven times: 60 Hz with every interval
/// between 0.3 and 1.7 of the mean one (a fixed sequence, fractions of multiples of the golden
/// ratio).
std::vector<CopSample> UnevenCircle() {
  std::vector<CopSample> samples;
  double time_s = 0;
  for (int k = 0; time_s < 20; ++k) {
    const double angle = 2 * kPi * 0.25 * time_s;
    samples.push_back({time_s, 0.01 * std::cos(angle), 0.01 * std::sin(angle)});
    time_s += (0.3 + 1.4 * std::fmod(k * 0.6180339887498949, 1.0)) / 60;
  }
  return samples;
}

TEST(Resample, GivesEvenTimesFromTheFirstSampleOn) {
  const std::vector<CopSample> even = Resample(UnevenCircle(), 25, 0.08);
  ASSERT_GE(even.size(), 499u);
  for (std::size_t k = 0; k < even.size(); ++k) {
    EXPECT_DOUBLE_EQ(even[k].time_s, static_cast<double>(k) / 25);
  }
}

TEST(Resample, KeepsACircleWithinTheWindowsAttenuation) {
  // A window of w attenuates a tone of f by sinc(f w): 0.9993 at 0.25 Hz and 0.08 s.
  const Sway sway = Measure({Resample(UnevenCircle(), 25, 0.08)});
  EXPECT_NEAR(sway.rms_radial_m, 0.01, 0.01 * 0.005);
  // The speed on the circle is 2 pi 0.25 Hz 10 mm.
  EXPECT_NEAR(sway.mean_velocity_mps, 2 * kPi * 0.25 * 0.01, 2 * kPi * 0.25 * 0.01 * 0.02);
}

TEST(Resample, AConstantStaysWhateverTheTimes) {
  std::vector<CopSample> samples = UnevenCircle();
  for (CopSample& sample : samples) sample.x_m = sample.y_m = 0.125;
  for (const CopSample& sample : Resample(samples, 50, 0.25)) {
    EXPECT_NEAR(sample.x_m, 0.125, 1e-15);
    EXPECT_NEAR(sample.y_m, 0.125, 1e-15);
  }
}

TEST(Resample, WeighsASampleByTheTimeItStandsFor) {
  // Of the window [0, 2] around 1, the sample at 0 stands for [0, 0.25], that at 0.5 for
  // [0.25, 1.25], that at 2 for [1.25, 2]: (0.25 * 0 + 1 * 4 + 0.75 * 8) / 2 = 5.
  const std::vector<CopSample> samples = {{0, 0, 0}, {0.5, 4, 0}, {2, 8, 0}};
  const std::vector<CopSample> even = Resample(samples, 1, 2);
  ASSERT_EQ(even.size(), 3u);
  EXPECT_DOUBLE_EQ(even[1].x_m, 5);
}

TEST(Resample, OneSampleAndEqualTimesGiveThatSample) {
  const std::vector<CopSample> one = {{3, 1, 2}};
  ASSERT_EQ(Resample(one, 100, 0.02).size(), 1u);
  EXPECT_EQ(Resample(one, 100, 0.02)[0].x_m, 1);
  const std::vector<CopSample> two = {{3, 1, 2}, {3, 1, 2}};
  EXPECT_EQ(Resample(two, 100, 0.02)[0].y_m, 2);
}

}  // namespace
}  // namespace footing::posturography
