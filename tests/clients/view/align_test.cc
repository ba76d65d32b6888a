#include "clients/view/scene/timeline.h"

#include <gtest/gtest.h>

#include "tests/clients/view/sample_timeline.h"

namespace footing::timeline {
namespace {

/// p07-1, and the same trial recorded 1000 s later by the wall clock, whose recording has its start
/// line at 7 s and its finish at 25 s.
std::array<Side, 2> Sides() {
  const Timeline whole = SampleTimeline();
  const Timeline first = Only(whole, whole.trials[0]);
  Timeline second = Shifted(first, 5);
  second.trials[0].end_s = 25;
  return {Side{first, 1'000'000'000'000}, Side{second, 2'000'000'000'000}};
}

TEST(AlignTest, StartLinesAreZeroOfBoth) {
  const auto zeros = ZerosOf(Sides(), Alignment::kStart);
  ASSERT_TRUE(zeros.ok());
  EXPECT_EQ((*zeros)[0], 12);
  EXPECT_EQ((*zeros)[1], 7);
}

TEST(AlignTest, ATrialThatNeverStartedIsAlignedAtItsBeginning) {
  std::array<Side, 2> sides = Sides();
  sides[1].timeline.trials[0].start_s.reset();
  EXPECT_EQ((*ZerosOf(sides, Alignment::kStart))[1], 5);
  sides[1].timeline.trials.clear();
  sides[1].timeline.begin_s = 3;
  EXPECT_EQ((*ZerosOf(sides, Alignment::kStart))[1], 3);
}

TEST(AlignTest, FinishesAreZeroOfBothAndMustBeThere) {
  std::array<Side, 2> sides = Sides();
  const auto zeros = ZerosOf(sides, Alignment::kFinish);
  ASSERT_TRUE(zeros.ok());
  EXPECT_EQ((*zeros)[0], 40);
  EXPECT_EQ((*zeros)[1], 25);
  sides[1].timeline.trials[0].end_s.reset();
  ASSERT_FALSE(ZerosOf(sides, Alignment::kFinish).ok());
  EXPECT_EQ(ZerosOf(sides, Alignment::kFinish).error().kind, ErrorKind::kUsage);
}

TEST(AlignTest, TheTimeOfDayIsTheSameOnBothSides) {
  std::array<Side, 2> sides = Sides();
  const auto zeros = ZerosOf(sides, Alignment::kWall);
  ASSERT_TRUE(zeros.ok());
  // Position 10 s of the first is at 1010 s; that is 990 s before the second one's zero.
  EXPECT_EQ((*zeros)[0], 10);
  EXPECT_DOUBLE_EQ((*zeros)[1], -990);
  sides[0].wall_of_zero_ns.reset();
  EXPECT_FALSE(ZerosOf(sides, Alignment::kWall).ok());
}

TEST(AlignTest, AShorterSideStaysAtItsEnds) {
  Timeline side;
  side.begin_s = -2;
  side.end_s = 10;
  EXPECT_EQ(SideAt(side, 3).at_s, 3);
  EXPECT_FALSE(SideAt(side, 3).finished);
  EXPECT_EQ(SideAt(side, 12).at_s, 10);
  EXPECT_TRUE(SideAt(side, 12).finished);
  EXPECT_TRUE(SideAt(side, 10).finished);
  EXPECT_EQ(SideAt(side, -5).at_s, -2);
  EXPECT_TRUE(SideAt(side, -5).before);
}

TEST(AlignTest, OneTimelineHoldsTheMarksOfBothByTime) {
  const std::array<Side, 2> sides = Sides();
  const Timeline joined = Joined(Shifted(sides[0].timeline, 12), Shifted(sides[1].timeline, 7.5));
  EXPECT_EQ(joined.begin_s, -2.5);
  EXPECT_EQ(joined.end_s, 30);
  ASSERT_EQ(joined.failures.size(), 4u);
  for (std::size_t i = 1; i < joined.failures.size(); ++i) {
    EXPECT_LE(joined.failures[i - 1].at_s, joined.failures[i].at_s);
  }
  EXPECT_EQ(joined.trials.size(), 2u);
  EXPECT_EQ(joined.tasks.size(), 2u);
}

}  // namespace
}  // namespace footing::timeline
