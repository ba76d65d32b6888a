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
  frame.characters[0].gait.commanded_by_stream = true;
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

TEST(Tally, AGaitThatNoReceivedFeaturesCommandDoesNotCount) {
  Tally tally;
  WorldFrame frame = FrameOf(0, stream::Gait::kStep, 0);
  tally.Add(frame);
  frame = FrameOf(1, stream::Gait::kStep, 10);
  frame.characters[0].gait.commanded_by_stream = false;
  tally.Add(frame);
  tally.Add(FrameOf(2.9, stream::Gait::kStep, 20));
  EXPECT_TRUE(tally.GaitsSeen().empty());
  tally.Add(FrameOf(3.0, stream::Gait::kStep, 20));
  EXPECT_EQ(tally.GaitsSeen(), std::vector{stream::Gait::kStep});
}

TEST(Tally, FramesPublishedCountThoseThatWereNotReceived) {
  Tally tally;
  WorldFrame frame = FrameOf(0, stream::Gait::kStep, 0);
  frame.sequence = 100;
  tally.Add(frame);
  frame.time_s = 1;
  frame.sequence = 110;
  tally.Add(frame);
  EXPECT_EQ(tally.frames(), 2u);
  EXPECT_EQ(tally.frames_published(), 11u);  // 100 to 110.
}

TEST(Tally, AResponseIsSplitIntoItsStages) {
  Tally tally;
  stream::ResponseStages response;
  response.report_received_ns = 1'000'000;
  response.decoded_ns = 2'000'000;
  response.features_computed_ns = 4'000'000;
  response.features_received_ns = 5'000'000;
  response.command_ns = 6'000'000;
  response.contact_ns = 206'000'000;
  response.first_frame_ns = 210'000'000;
  tally.Add(response);
  tally.Add(stream::ResponseStages());  // Without stamps it counts for nothing.
  EXPECT_EQ(tally.response_without_contact.count(), 1u);
  EXPECT_DOUBLE_EQ(tally.response_without_contact.QuantileMs(0.95), 9);  // 5 before, 4 behind.
  EXPECT_DOUBLE_EQ(tally.response_stages["contact"].QuantileMs(0.95), 200);
}

TEST(Tally, ThreeJumpsAreThreeCycles) {
  Tally tally;
  tally.Add(FrameOf(0, stream::Gait::kJump, 10));
  tally.Add(FrameOf(2.5, stream::Gait::kJump, 13));
  EXPECT_EQ(tally.GaitsSeen(), std::vector{stream::Gait::kJump});
}

TEST(Tally, FailuresByCauseAndOperatorPutBacksCountOverARestart) {
  Tally tally;
  WorldFrame frame = FrameOf(100, stream::Gait::kWalk, 0, 9);
  const auto add = [&](double time_s, stream::FailureCounts failures, std::uint64_t put_backs) {
    frame.time_s = time_s;
    frame.characters[0].gait.failures = failures;
    frame.characters[0].gait.operator_put_backs = put_backs;
    tally.Add(frame);
  };
  add(100, {3, 2, 1, 0, 7}, 3);
  add(101, {4, 2, 3, 1, 7}, 4);
  add(0.01, {0, 0, 0, 0, 0}, 0);
  add(1, {0, 5, 0, 0, 2}, 1);
  EXPECT_EQ(tally.failures(), (stream::FailureCounts{1, 5, 2, 1, 2}));
  EXPECT_EQ(tally.operator_put_backs(), 2u);
}

TEST(Tally, TimeBesideTheTrackCounts) {
  Tally tally;
  WorldFrame frame = FrameOf(10, stream::Gait::kWalk, 0);
  for (int i = 0; i <= 100; ++i) {
    frame.time_s = 10 + 0.01 * i;
    frame.characters[0].trial.emplace();
    frame.characters[0].trial->progress.on_track = i <= 40 || i > 65;
    tally.Add(frame);
  }
  EXPECT_NEAR(tally.off_track_s(), 0.25, 1e-9);  // Frames 41 to 65.
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
