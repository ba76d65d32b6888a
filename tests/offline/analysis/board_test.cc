#include "daemon/offline/analysis/board.h"

#include <gtest/gtest.h>

namespace footing::posturography {
namespace {

/// A person of 600 N whose COP is at (x, y), at time_s.
CornerSample Standing600(double time_s, double x_m, double y_m) {
  const double right = x_m / 0.433;  // Share beyond one half on the right.
  const double top = y_m / 0.238;
  return {time_s, 600 * (0.5 - right) * (0.5 + top), 600 * (0.5 + right) * (0.5 + top),
          600 * (0.5 - right) * (0.5 - top), 600 * (0.5 + right) * (0.5 - top)};
}

TEST(Board, CentreOfPressureIsWhereTheForcesBalance) {
  const Standing standing = FindStanding({Standing600(0, 0.05, -0.03)}, {});
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
  const Standing standing = FindStanding(samples, {});
  ASSERT_EQ(standing.stretches.size(), 2u);
  EXPECT_EQ(standing.samples, 19u);
  EXPECT_EQ(Measure(standing.stretches).path_m, 0);  // Nobody walked the 2 cm between.
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
  const Standing standing = FindStanding(samples, {});
  EXPECT_EQ(standing.stretches.size(), 3u);
  EXPECT_EQ(standing.gaps.count, 1u);
  EXPECT_NEAR(standing.gaps.seconds, 2.91, 1e-9);
}

TEST(Board, AnEmptyBoardHasNoWeight) {
  EXPECT_EQ(FindStanding({{0, 1, 1, 1, 1}, {0.01, 2, 2, 2, 2}}, {}).weight_n, 0);
  EXPECT_EQ(FindStanding({}, {}).weight_n, 0);
}

TEST(Board, WeightIsNotMovedByStepsOnAndOff) {
  std::vector<CornerSample> samples;
  for (int k = 0; k < 5; ++k) samples.push_back({0.01 * k, 20 + 10.0 * k, 20, 20, 20});
  for (int k = 5; k < 50; ++k) samples.push_back(Standing600(0.01 * k, 0, 0));
  EXPECT_NEAR(FindStanding(samples, {}).weight_n, 600, 1e-9);
}

}  // namespace
}  // namespace footing::posturography
