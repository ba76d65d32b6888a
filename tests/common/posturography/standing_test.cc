#include "common/posturography/standing.h"

#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "common/base/units.h"

namespace footing::posturography {
namespace {

/// A person of 600 N whose COP is at (x, y), at time_s.
CornerSample Standing600(double time_s, double x_m, double y_m) {
  const double right = x_m / 0.433;  // Share beyond one half on the right.
  const double top = y_m / 0.238;
  return {time_s, 600 * (0.5 - right) * (0.5 + top), 600 * (0.5 + right) * (0.5 + top),
          600 * (0.5 - right) * (0.5 - top), 600 * (0.5 + right) * (0.5 - top)};
}

Standing Find(const std::vector<CornerSample>& samples) {
  return FindStanding(LoadsOn(samples), {});
}

TEST(Board, CentreOfPressureIsWhereTheForcesBalance) {
  const Standing standing = Find({Standing600(0, 0.05, -0.03)});
  ASSERT_EQ(standing.samples, 1u);
  EXPECT_NEAR(standing.weight_n, 600, 1e-9);
  EXPECT_NEAR(standing.stretches[0][0].x_m, 0.05, 1e-12);
  EXPECT_NEAR(standing.stretches[0][0].y_m, -0.03, 1e-12);
}

TEST(Board, SteppingOffEndsAStretch) {
  std::vector<CornerSample> samples;
  for (int k = 0; k < 10; ++k) samples.push_back(Standing600(0.01 * k, 0.01, 0));
  samples.push_back({0.1, 1, 1, 1, 1});  // 4 N: nobody.
  for (int k = 11; k < 20; ++k) samples.push_back(Standing600(0.01 * k, -0.01, 0));
  const Standing standing = Find(samples);
  ASSERT_EQ(standing.stretches.size(), 2u);
  EXPECT_EQ(standing.samples, 19u);
  EXPECT_EQ(Measure(standing.stretches, 0).path_m, 0);  // Nobody walked the 2 cm between.
}

TEST(Board, AGapInTheRecordingEndsAStretchAndIsCounted) {
  std::vector<CopSample> samples = {{0, 0, 0}, {0.01, 0, 0}, {0.02, 0, 0}, {0.41, 1, 0}};
  const Standing cut = SplitAtGaps(samples);
  EXPECT_EQ(cut.stretches.size(), 2u);  // 0.39 s is longer than 0.2 s.
  EXPECT_EQ(cut.gaps.count, 1u);
  EXPECT_NEAR(cut.gaps.longest_s, 0.39, 1e-12);
  EXPECT_NEAR(cut.gaps.seconds, 0.39, 1e-12);
  samples[3].time_s = 0.2;
  EXPECT_EQ(SplitAtGaps(samples).stretches.size(), 1u);
  EXPECT_EQ(SplitAtGaps(samples).gaps.count, 0u);
}

TEST(Board, TimeOffTheBoardIsNotAGap) {
  std::vector<CornerSample> samples;
  for (int k = 0; k < 10; ++k) samples.push_back(Standing600(0.01 * k, 0, 0));
  samples.push_back({0.1, 1, 1, 1, 1});
  for (int k = 0; k < 10; ++k) samples.push_back(Standing600(9 + 0.01 * k, 0, 0));
  samples.push_back(Standing600(12, 0, 0));
  const Standing standing = Find(samples);
  EXPECT_EQ(standing.stretches.size(), 3u);
  EXPECT_EQ(standing.gaps.count, 1u);
  EXPECT_NEAR(standing.gaps.seconds, 2.91, 1e-9);
}

TEST(Board, AnEmptyBoardHasNoWeight) {
  EXPECT_EQ(Find({{0, 1, 1, 1, 1}, {0.01, 2, 2, 2, 2}}).weight_n, 0);
  EXPECT_EQ(Find({}).weight_n, 0);
}

TEST(Board, WeightIsNotMovedByStepsOnAndOff) {
  std::vector<CornerSample> samples;
  for (int k = 0; k < 5; ++k) samples.push_back({0.01 * k, 20 + 10.0 * k, 20, 20, 20});
  for (int k = 5; k < 50; ++k) samples.push_back(Standing600(0.01 * k, 0, 0));
  EXPECT_NEAR(Find(samples).weight_n, 600, 1e-9);
}

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
  const Sway sway = Measure({Resample(UnevenCircle(), 25, 0.08)}, 25);
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
  // Within the window [0, 2] around 1, the sample at 0 stands for [0, 0.25], that at 0.5 for
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

/// A person of 600 N on two boards, side by side along y: the left one bears `left_share`, and each
/// foot's COP is at (x, y) of its board. Boards sample at 60 Hz, at times of their own.
std::array<Loads, 2> OnTwoBoards(double seconds, double (*left_share)(double time_s)) {
  std::array<Loads, 2> loads;
  for (std::size_t side = 0; side < 2; ++side) {
    std::vector<CornerSample> samples;
    double time_s = side == 0 ? 0 : 0.007;
    for (int k = 0; time_s < seconds; ++k) {
      const double share = side == 0 ? left_share(time_s) : 1 - left_share(time_s);
      CornerSample sample = Standing600(time_s, 0.01, 0.02);
      for (double* force : {&sample.forces.top_left_n, &sample.forces.top_right_n,
                            &sample.forces.bottom_left_n, &sample.forces.bottom_right_n}) {
        *force *= share;
      }
      samples.push_back(sample);
      time_s += (0.5 + std::fmod((k + 3 * static_cast<double>(side)) * 0.618, 1.0)) / 60;
    }
    loads[side] = LoadsOn(samples, {0, side == 0 ? 0.2 : -0.2, 0});
  }
  return loads;
}

TEST(Merged, TheCopIsWeighedByTheLoads) {
  const auto loads =
      OnTwoBoards(10, [](double t) { return 0.5 + 0.2 * std::sin(2 * kPi * 0.5 * t); });
  const Standing standing = FindStanding(Merged(loads[0], loads[1], 50, 0.04), {});
  EXPECT_NEAR(standing.weight_n, 600, 1);
  ASSERT_EQ(standing.stretches.size(), 1u);
  EXPECT_GT(standing.samples, 490u);
  for (const CopSample& sample : standing.stretches[0]) {
    if (sample.time_s < 0.1 || sample.time_s > 9.8) continue;  // There windows are cut.
    // 0.2 m to the left or the right, and 0.01 m right and 0.02 m front on each board.
    const double left = 0.5 + 0.2 * std::sin(2 * kPi * 0.5 * sample.time_s);
    EXPECT_NEAR(sample.x_m, 0.01 - 0.2 * (2 * left - 1), 0.002);
    EXPECT_NEAR(sample.y_m, 0.02, 1e-9);
  }
}

TEST(Merged, AGapOfOneBoardIsAGap) {
  auto loads = OnTwoBoards(10, [](double) { return 0.5; });
  std::erase_if(loads[1],
                [](const LoadSample& load) { return load.time_s > 4 && load.time_s < 5; });
  const Standing standing = FindStanding(Merged(loads[0], loads[1], 50, 0.04), {});
  EXPECT_EQ(standing.stretches.size(), 2u);
  EXPECT_EQ(standing.gaps.count, 1u);
  EXPECT_NEAR(standing.gaps.seconds, 1.03, 0.05);
  EXPECT_TRUE(Merged(loads[0], {}, 50, 0.04).empty());
}

TEST(EvenRate, IsThatOfEvenSamplesOnly) {
  std::vector<CopSample> samples;
  for (int k = 0; k < 101; ++k) samples.push_back({k / 50.0, 0, 0});
  EXPECT_NEAR(EvenRate({samples}), 50, 1e-9);
  EXPECT_EQ(EvenRate({UnevenCircle()}), 0);
  EXPECT_EQ(EvenRate({{{0, 0, 0}}}), 0);
}

}  // namespace
}  // namespace footing::posturography
