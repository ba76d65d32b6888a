#include "clients/view/scene/timeline.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include "tests/clients/view/sample_timeline.h"

namespace footing::timeline {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(TimelineTest, FailuresAreFoundBothWaysAndNotWhereOneStands) {
  const Timeline line = SampleTimeline();
  EXPECT_EQ(NextFailure(line, 0), 20);
  EXPECT_EQ(NextFailure(line, 20), 30);
  EXPECT_EQ(NextFailure(line, 30.0005), 60);
  EXPECT_EQ(NextFailure(line, 60), std::nullopt);
  EXPECT_EQ(PreviousFailure(line, 100), 60);
  EXPECT_EQ(PreviousFailure(line, 60), 30);
  EXPECT_EQ(PreviousFailure(line, 20), std::nullopt);
}

TEST(TimelineTest, MarkersFrameTrialsAndStayMarks) {
  Timeline line;
  line.end_s = 100;
  line.markers = {{10, "begin p07-1", {}},
                  {12, "stimulus", 3.5},
                  {40, "end p07-1", {}},
                  {45, "end p07-1", {}},
                  {50, "begin p07-2", {}}};
  line.trials = TrialsOf(line.markers);
  ASSERT_EQ(line.trials.size(), 2u);
  EXPECT_EQ(line.trials[0].id, "p07-1");
  EXPECT_EQ(line.trials[0].begin_s, 10);
  EXPECT_EQ(line.trials[0].end_s, 40);
  EXPECT_EQ(line.trials[0].time_s, 30);
  EXPECT_EQ(line.trials[1].end_s, std::nullopt);
  const Timeline only = Only(line, line.trials[0]);
  ASSERT_EQ(only.markers.size(), 3u);  // With the two seconds behind the end, as of every trial.
  EXPECT_EQ(Shifted(only, 10).markers[1].at_s, 2);
  EXPECT_THAT(MarkLines(only), ::testing::Contains(HasSubstr("0:12.0  marker: stimulus (3.5)")));
  EXPECT_EQ(Joined(only, line).markers.size(), 8u);
}

TEST(TimelineTest, TrialsAreFoundByPositionNameAndNumber) {
  const Timeline line = SampleTimeline();
  EXPECT_EQ(TrialAt(line, 9), nullptr);
  EXPECT_EQ(TrialAt(line, 10)->id, "p07-1");
  EXPECT_EQ(TrialAt(line, 45)->id, "p07-1");
  EXPECT_EQ(TrialAt(line, 99)->number, 2u);
  EXPECT_EQ(NextTrial(line, 0), 10);
  EXPECT_EQ(NextTrial(line, 10), 50);
  EXPECT_EQ(NextTrial(line, 70), 10);
  EXPECT_EQ(NextTrial({}, 0), std::nullopt);
  EXPECT_EQ(FindTrial(line, "p07-1")->begin_s, 10);
  EXPECT_EQ(FindTrial(line, "#2")->begin_s, 50);
  EXPECT_EQ(FindTrial(line, "trial 2")->begin_s, 50);
}

TEST(TimelineTest, AnUnknownTrialListsThoseThatThereAre) {
  const auto unknown = FindTrial(SampleTimeline(), "p08");
  ASSERT_FALSE(unknown.ok());
  EXPECT_EQ(unknown.error().kind, ErrorKind::kUsage);
  EXPECT_THAT(unknown.error().message, HasSubstr("p07-1 (#1), trial 2 (#2)"));
  const auto none = FindTrial({}, "p08");
  ASSERT_FALSE(none.ok());
  EXPECT_EQ(none.error().kind, ErrorKind::kInvalidData);
}

TEST(TimelineTest, FailuresCountForTheirTrialUnlessWithdrawn) {
  const Timeline line = SampleTimeline();
  const stream::FailureCounts counts = FailuresOf(line, line.trials[0], 100);
  EXPECT_EQ(counts.curve, 1u);
  EXPECT_EQ(stream::Total(counts), 1u);
  EXPECT_EQ(stream::Total(FailuresOf(line, line.trials[0], 19.9)), 0u);
  EXPECT_EQ(FailuresOf(line, line.trials[1], 100).simulation, 1u);
}

TEST(TimelineTest, FallsBehindAStoppedTrialDoNotCountForIt) {
  Timeline line = SampleTimeline();
  line.trials[0].phase = stream::TrialPhase::kStopped;
  FailureMark& late = line.failures.emplace_back(line.failures[0]);
  late.at_s = 45;
  EXPECT_EQ(stream::Total(FailuresOf(line, line.trials[0], 100)), 1u);
}

TEST(TimelineTest, AFailureOfATrialWithAnIdNamesIt) {
  Timeline line = SampleTimeline();
  line.failures[0].number = 1;
  EXPECT_EQ(stream::Total(FailuresOf(line, line.trials[0], 100)), 0u);
  line.failures[0].trial = "p07-1";
  EXPECT_EQ(stream::Total(FailuresOf(line, line.trials[0], 100)), 1u);
}

TEST(TimelineTest, OneTrialAloneEndsTwoSecondsAfterItsEndAndHasItsOwnMarks) {
  const Timeline line = SampleTimeline();
  const Timeline only = Only(line, line.trials[0]);
  EXPECT_EQ(only.begin_s, 10);
  EXPECT_EQ(only.end_s, 42);
  EXPECT_EQ(only.trials.size(), 1u);
  EXPECT_EQ(only.failures.size(), 2u);
  EXPECT_EQ(only.tasks.size(), 1u);
  EXPECT_EQ(Only(line, line.trials[1]).end_s, 100);
}

TEST(TimelineTest, OneTrialAloneDoesNotReachIntoTheNextOne) {
  Timeline line = SampleTimeline();
  line.trials[1].begin_s = 41;
  EXPECT_LT(Only(line, line.trials[0]).end_s, 41);
  EXPECT_GT(Only(line, line.trials[0]).end_s, 40.99);
}

TEST(TimelineTest, ShiftingMovesEveryMark) {
  const Timeline line = Shifted(SampleTimeline(), 12);
  EXPECT_EQ(line.begin_s, -12);
  EXPECT_EQ(line.end_s, 88);
  EXPECT_EQ(line.trials[0].begin_s, -2);
  EXPECT_EQ(line.trials[0].start_s, 0);
  EXPECT_EQ(line.trials[0].end_s, 28);
  EXPECT_EQ(line.trials[1].start_s, std::nullopt);
  EXPECT_EQ(line.failures[0].at_s, 8);
  EXPECT_EQ(line.tasks[0].at_s, 23);
}

TEST(TimelineTextTest, ClocksHaveTenthsMinutesAndHours) {
  EXPECT_EQ(ClockText(0), "0:00.0");
  EXPECT_EQ(ClockText(12.34), "0:12.3");
  EXPECT_EQ(ClockText(59.96), "1:00.0");
  EXPECT_EQ(ClockText(-1.5), "-0:01.5");
  EXPECT_EQ(ClockText(-0.01), "0:00.0");
  EXPECT_EQ(ClockText(3723.4), "1:02:03.4");
}

TEST(TimelineTextTest, PositionTrialAndMarksAreReadable) {
  PlayHead head = HeadAt(0, 100, 0.25);
  head.at_s = 25;
  head.paused = true;
  EXPECT_EQ(PositionText(head), "0:25.0 of 1:40.0   speed 0.25   paused");
  EXPECT_EQ(TrialText(SampleTimeline(), 25), "trial p07-1   failed attempts 1 (curve 1)");
  EXPECT_EQ(TrialText(SampleTimeline(), 5), "");
  EXPECT_THAT(
      MarkLines(SampleTimeline()),
      ElementsAre("0:10.0  trial p07-1 ready, track straight",
                  "0:12.0  trial p07-1 crosses the start line", "0:20.0  failure: curve, at 0.0 m",
                  "0:30.0  failure: jump, at 0.0 m, withdrawn", "0:35.0  task run_walk done",
                  "0:40.0  trial p07-1 finished, 28.00 s", "0:50.0  trial 2 ready",
                  "1:00.0  failure: simulation, at 0.0 m"));
}

TEST(Timeline, TheMarkNearestToTheMouseSaysWhatItIs) {
  Timeline line = SampleTimeline();
  line.events = {{36, "T-pose taken: 71.2 kg"}};
  EXPECT_EQ(TextAt(line, 35.7, 1), "0:36.0  T-pose taken: 71.2 kg");
  EXPECT_EQ(TextAt(line, 35.2, 1), "0:35.0  task run_walk done");
  EXPECT_EQ(TextAt(line, 80, 1), "1:20.0");
  // They move with the zero, stay with their trial, and are listed.
  EXPECT_EQ(Shifted(line, 12).events[0].at_s, 24);
  EXPECT_EQ(Only(line, line.trials[0]).events.size(), 1u);
  EXPECT_EQ(Only(line, line.trials[1]).events.size(), 0u);
  EXPECT_EQ(Joined(line, line).events.size(), 2u);
  const std::vector<std::string> lines = MarkLines(line);
  EXPECT_EQ(std::count(lines.begin(), lines.end(), "0:36.0  T-pose taken: 71.2 kg"), 1);
}

}  // namespace
}  // namespace footing::timeline
