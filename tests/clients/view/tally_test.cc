#include "clients/view/scene/tally.h"

#include <gtest/gtest.h>

namespace footing::scene {
namespace {

WorldFrame FrameOf(double time_s, stream::Gait gait, std::uint64_t steps, std::uint64_t falls = 0,
                   double distance_m = 0) {
  WorldFrame frame;
  frame.time_s = time_s;
  frame.characters.resize(1);
  frame.characters[0].gait.gait = gait;
  frame.characters[0].gait.steps = steps;
  frame.characters[0].gait.falls = falls;
  frame.characters[0].gait.distance_m = distance_m;
  return frame;
}

TEST(Latencies, QuantilesAreThoseOfTheSortedList) {
  Latencies latencies;
  for (int ms = 100; ms >= 0; --ms) latencies.Add(ms * 1'000'000);
  EXPECT_DOUBLE_EQ(latencies.QuantileMs(0.5), 50);
  EXPECT_DOUBLE_EQ(latencies.QuantileMs(0.99), 99);
  EXPECT_DOUBLE_EQ(latencies.LastMs(), 0);
  EXPECT_DOUBLE_EQ(Latencies().QuantileMs(0.5), 0);
}

TEST(Tally, AGaitIsSeenAfterTwoSecondsAndThreeCycles) {
  Tally tally;
  tally.Add(FrameOf(0, stream::Gait::kWalk, 0));
  tally.Add(FrameOf(1.9, stream::Gait::kWalk, 6));
  EXPECT_TRUE(tally.GaitsSeen().empty());
  tally.Add(FrameOf(2.0, stream::Gait::kWalk, 6));
  EXPECT_EQ(tally.GaitsSeen(), std::vector{stream::Gait::kWalk});
}

TEST(Tally, TooFewStepsOrAnInterruptionDoNotCount) {
  Tally tally;
  tally.Add(FrameOf(0, stream::Gait::kRun, 0));
  tally.Add(FrameOf(5, stream::Gait::kRun, 5));
  tally.Add(FrameOf(5.1, stream::Gait::kStep, 6));
  tally.Add(FrameOf(5.2, stream::Gait::kRun, 7));
  tally.Add(FrameOf(7.1, stream::Gait::kRun, 20));
  EXPECT_TRUE(tally.GaitsSeen().empty());
  tally.Add(FrameOf(7.3, stream::Gait::kRun, 21));
  EXPECT_EQ(tally.GaitsSeen(), std::vector{stream::Gait::kRun});
}

TEST(Tally, ThreeJumpsAreThreeCycles) {
  Tally tally;
  tally.Add(FrameOf(0, stream::Gait::kJump, 10));
  tally.Add(FrameOf(2.5, stream::Gait::kJump, 13));
  EXPECT_EQ(tally.GaitsSeen(), std::vector{stream::Gait::kJump});
}

TEST(Tally, FallsAndDistanceCountFromTheFirstFrameAndOverARestart) {
  Tally tally;
  tally.Add(FrameOf(100, stream::Gait::kWalk, 0, 3, 50));
  tally.Add(FrameOf(101, stream::Gait::kWalk, 0, 4, 51.5));
  tally.Add(FrameOf(0.01, stream::Gait::kStep, 0, 0, 0));
  tally.Add(FrameOf(1, stream::Gait::kStep, 0, 1, 0.5));
  EXPECT_EQ(tally.falls(), 2u);
  EXPECT_DOUBLE_EQ(tally.distance_m(), 2.0);
  EXPECT_EQ(tally.frames(), 4u);
}

}  // namespace
}  // namespace footing::scene
