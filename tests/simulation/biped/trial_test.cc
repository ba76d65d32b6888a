#include "daemon/simulation/biped/trial.h"

#include <gtest/gtest.h>

#include <set>

#include "daemon/simulation/biped/track.h"
#include "tests/simulation/test_world.h"

namespace footing::trial {
namespace {

using stream::FailureCause;
using stream::Gait;
using stream::TaskPhase;
using stream::TrialPhase;

stream::Track TrackNamed(const std::string& name) {
  return terrain::ParseTrack(test::DataFile("tracks/" + name + ".json"), name).value();
}

int TaskNamed(const stream::Track& track, const std::string& name) {
  for (std::size_t i = 0; i < track.tasks.size(); ++i) {
    if (track.tasks[i].name == name) return static_cast<int>(i);
  }
  return -1;
}

/// A character that goes along a track at a constant speed, and what the trial says of it.
struct Course {
  stream::Track track;
  TrialMemory memory;
  double time_s = 0, distance_m = 0;
  TrialNews all = {};

  explicit Course(const std::string& name, const std::string& task = "")
      : track(TrackNamed(name)), memory(Begin(track, TaskNamed(track, task))) {}

  void Go(double distance, Gait gait, double speed_mps) {
    const double until_m = distance_m + distance;
    while (distance_m < until_m) Step(gait, speed_mps);
  }
  void Wait(double seconds, Gait gait, double speed_mps = 0) {
    const double until_s = time_s + seconds;
    while (time_s < until_s) Step(gait, speed_mps);
  }
  void Step(Gait gait, double speed_mps) {
    time_s += 0.001;
    distance_m += 0.001 * speed_mps;
    const TrialNews news = Advance(track, {time_s, distance_m, gait, speed_mps}, memory);
    all.started = all.started || news.started;
    all.finished = all.finished || news.finished;
    all.task_done = all.task_done || news.task_done;
    if (news.failed != nullptr) all.failed = news.failed;
  }
};

TEST(Trial, ItsClockRunsFromTheStartLineToTheFinishLine) {
  Course course("1");
  course.Wait(5, Gait::kStep);
  EXPECT_EQ(course.memory.phase, TrialPhase::kReady);
  EXPECT_EQ(TimeOf(course.memory, course.time_s), 0);
  course.Go(1.1, Gait::kWalk, 1);
  EXPECT_TRUE(course.all.started);
  EXPECT_EQ(course.memory.phase, TrialPhase::kRunning);
  EXPECT_NEAR(TimeOf(course.memory, course.time_s), 0.1, 0.005);
  course.Go(course.track.finish_m - course.distance_m - 0.05, Gait::kWalk, 2);
  EXPECT_FALSE(course.all.finished);
  course.Go(0.1, Gait::kWalk, 2);
  EXPECT_TRUE(course.all.finished);
  EXPECT_EQ(course.memory.phase, TrialPhase::kFinished);
  // From the line at 1 m: 0.1 m at 1 m/s, the rest at 2 m/s.
  const double expected_s = 0.1 + (course.track.finish_m - 1.1) / 2;
  EXPECT_NEAR(TimeOf(course.memory, course.time_s), expected_s, 0.01);
  course.Wait(10, Gait::kStep);
  EXPECT_NEAR(TimeOf(course.memory, course.time_s), expected_s, 0.01);
}

TEST(Trial, WithoutAFinishLineItGoesOnUntilItIsStopped) {
  Course course("plain");
  course.Go(300, Gait::kRun, 4);
  EXPECT_EQ(course.memory.phase, TrialPhase::kRunning);
  Stop(course.time_s, course.memory);
  EXPECT_EQ(course.memory.phase, TrialPhase::kStopped);
  EXPECT_NEAR(TimeOf(course.memory, course.time_s + 9), (300 - 1) / 4.0, 0.01);
  Stop(course.time_s + 5, course.memory);  // Without effect on a trial that is over.
  EXPECT_NEAR(TimeOf(course.memory, course.time_s + 9), (300 - 1) / 4.0, 0.01);
  EXPECT_FALSE(GoesOn(course.memory));
}

TEST(Task, IsDoneASecondAfterItsGaitBegan) {
  Course course("straight", "walk_run");
  course.Go(29, Gait::kWalk, 1);
  EXPECT_EQ(course.memory.task_phase, TaskPhase::kAhead);
  course.Go(2, Gait::kWalk, 1);
  EXPECT_EQ(course.memory.task_phase, TaskPhase::kDue);
  course.Wait(0.9, Gait::kRun, 2);
  EXPECT_EQ(course.memory.task_phase, TaskPhase::kDue);
  course.Wait(0.2, Gait::kRun, 2);
  EXPECT_EQ(course.memory.task_phase, TaskPhase::kDone);
  EXPECT_TRUE(course.all.task_done);
  course.Go(40, Gait::kRun, 2);
  EXPECT_TRUE(course.all.finished);
  EXPECT_EQ(course.all.failed, nullptr);
}

TEST(Task, AGaitThatDoesNotLastIsNotATransition) {
  Course course("straight", "walk_run");
  course.Go(31, Gait::kWalk, 1);
  for (int i = 0; i < 6; ++i) {
    course.Wait(0.6, Gait::kRun, 1);
    course.Wait(0.6, Gait::kWalk, 1);
  }
  EXPECT_EQ(course.memory.task_phase, TaskPhase::kDue);
}

TEST(Task, OneJumpIsEnough) {
  Course course("straight", "run_jump");
  course.Go(31, Gait::kRun, 2.5);
  course.Wait(0.6, Gait::kJump, 2);
  course.Wait(0.5, Gait::kRun, 2);
  EXPECT_EQ(course.memory.task_phase, TaskPhase::kDone);
}

TEST(Task, AStopIsStandingStillNotSteppingOn) {
  Course course("straight", "walk_stop");
  course.Go(30.5, Gait::kWalk, 1);
  course.Wait(1.5, Gait::kStep, 0.6);
  EXPECT_EQ(course.memory.task_phase, TaskPhase::kDue);
  course.Wait(1.1, Gait::kStep, 0.05);
  EXPECT_EQ(course.memory.task_phase, TaskPhase::kDone);
}

TEST(Task, NotDoneWithinItsWayIsAFailedTransition) {
  Course course("straight", "walk_run");
  course.Go(30 + 14.9, Gait::kWalk, 1);
  EXPECT_EQ(course.all.failed, nullptr);
  course.Go(0.2, Gait::kWalk, 1);
  EXPECT_STREQ(course.all.failed, "the task was not done");
}

TEST(Task, CrossedInAnotherGaitThanTheFirstIsAFailedTransition) {
  Course course("straight", "walk_run");
  course.Go(20, Gait::kWalk, 1);
  course.Go(10.5, Gait::kRun, 3);  // Runs for 3.3 s before the line.
  EXPECT_STREQ(course.all.failed, "the gait before the line was not the task's");
  // A moment too early is not.
  Course early("straight", "walk_run");
  early.Go(28, Gait::kWalk, 1);
  early.Go(2.5, Gait::kRun, 3);
  EXPECT_EQ(early.all.failed, nullptr);
  early.Wait(1, Gait::kRun, 3);
  EXPECT_EQ(early.memory.task_phase, TaskPhase::kDone);
}

TEST(Task, ASeedDrawsOneOfAllAndTheSameAgain) {
  const stream::Track track = TrackNamed("straight");
  std::set<int> drawn;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    const int task = DrawTask(track, seed);
    EXPECT_EQ(DrawTask(track, seed), task);
    drawn.insert(task);
  }
  EXPECT_EQ(drawn, (std::set<int>{0, 1, 2, 3, 4, 5}));
  EXPECT_EQ(DrawTask(TrackNamed("1"), 7), -1);
}

TEST(Attribute, OnATestTrackEachKindStaysWhatItIs) {
  const Course course("3");
  for (const auto cause : {FailureCause::kSimulation, FailureCause::kCurve, FailureCause::kJump}) {
    EXPECT_EQ(Attribute(course.track, course.memory, cause), cause);
  }
}

TEST(Attribute, OnAStraightTrackLeavingItIsStraightnessAndWhileATaskIsDueAllIsTransition) {
  Course course("straight", "run_walk");
  course.Go(10, Gait::kRun, 3);
  const auto of = [&course](FailureCause cause) {
    return Attribute(course.track, course.memory, cause);
  };
  EXPECT_EQ(of(FailureCause::kCurve), FailureCause::kStraightness);
  EXPECT_EQ(of(FailureCause::kSimulation), FailureCause::kSimulation);
  course.Go(21, Gait::kRun, 3);
  EXPECT_EQ(of(FailureCause::kCurve), FailureCause::kTransition);
  EXPECT_EQ(of(FailureCause::kSimulation), FailureCause::kTransition);
  course.Wait(1.1, Gait::kWalk, 1);
  EXPECT_EQ(of(FailureCause::kCurve), FailureCause::kStraightness);
  EXPECT_EQ(of(FailureCause::kSimulation), FailureCause::kSimulation);
}

TEST(PutBack, AfterAFailedTransitionTheLineIsAheadAgain) {
  Course course("straight", "walk_run");
  course.Go(36, Gait::kWalk, 1);
  const double back_m = PutBackDistance(course.track, FailureCause::kTransition, 36, 3);
  EXPECT_NEAR(36 - back_m, 30 - kRunUpM, 1e-9);
  course.distance_m -= back_m;
  TakePutBack(course.track, course.distance_m, course.memory);
  EXPECT_EQ(course.memory.task_phase, TaskPhase::kAhead);
  course.all = {};
  course.Go(7, Gait::kWalk, 1);
  EXPECT_EQ(course.all.failed, nullptr);  // It walked up to the line.
  EXPECT_EQ(course.memory.task_phase, TaskPhase::kDue);
}

TEST(PutBack, GivesARunUpAfterAJumpWhereTheUserHasToTimeIt) {
  EXPECT_EQ(PutBackDistance(TrackNamed("1"), FailureCause::kJump, 20, 3), kRunUpM);
  EXPECT_EQ(PutBackDistance(TrackNamed("1"), FailureCause::kJump, 20, 9), 9);
  EXPECT_EQ(PutBackDistance(TrackNamed("pits"), FailureCause::kJump, 20, 3), 3);
  EXPECT_EQ(PutBackDistance(TrackNamed("1"), FailureCause::kCurve, 20, 3), 3);
}

TEST(PutBack, LeavesATaskThatIsDoneDone) {
  Course course("straight", "walk_run");
  course.Go(31, Gait::kWalk, 1);
  course.Wait(1.5, Gait::kRun, 2);
  ASSERT_EQ(course.memory.task_phase, TaskPhase::kDone);
  TakePutBack(course.track, 25, course.memory);
  EXPECT_EQ(course.memory.task_phase, TaskPhase::kDone);
}

}  // namespace
}  // namespace footing::trial
