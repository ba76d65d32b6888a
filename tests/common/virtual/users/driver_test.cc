#include "common/virtual/users/driver.h"

#include <gtest/gtest.h>

namespace footing::users {
namespace {

using stream::Gait;

stream::Track Straight(std::initializer_list<std::pair<double, bool>> lengths) {
  stream::Track track;
  track.help_over_pits = false;
  double from_m = 0;
  for (const auto& [length_m, pit] : lengths) {
    track.segments.push_back(
        {.start_m = {from_m, 0, 0}, .length_m = length_m, .width_m = 4, .pit = pit});
    from_m += length_m;
  }
  return track;
}

stream::Track PitAt20() { return Straight({{20, false}, {0.5, true}, {20, false}}); }

stream::Track StopAt20() {
  stream::Track track = Straight({{60, false}});
  track.mark_m = 20;
  track.tasks = {{.name = "stop", .before = Gait::kWalk, .after = Gait::kStep, .instruction = ""}};
  return track;
}

/// A character that runs along x as the user sees it, every 10 ms.
struct Runner {
  Driver driver;
  Observation seen;

  explicit Runner(const stream::Track& track, const Ability& ability = DirectAbility())
      : driver(ability, DrawStyle(7), 7) {
    driver.SeeTrack(track);
    seen.gait = Gait::kRun;
    seen.speed_mps = 2.5;
  }

  /// Until x; returns what was wanted last.
  Intention RunTo(double x_m) {
    Intention wanted;
    while (seen.p_W_m.x() < x_m) {
      seen.time_s += 0.01;
      seen.p_W_m.x() += 0.01 * seen.speed_mps;
      wanted = driver.Want(seen);
    }
    return wanted;
  }
};

TEST(Driver, JumpsBeforeAPitAndRunsOnBehindIt) {
  Runner runner(PitAt20());
  EXPECT_EQ(runner.RunTo(16).gait, Gait::kRun);
  EXPECT_EQ(runner.RunTo(19.9).gait, Gait::kJump);
  EXPECT_EQ(runner.RunTo(22.5).gait, Gait::kRun);
}

TEST(Driver, WalksUpToAPitThatCannotBeJumpedFromARun) {
  Ability ability;
  ability.jumps_from_run = false;
  Runner runner(PitAt20(), ability);
  EXPECT_EQ(runner.RunTo(10).gait, Gait::kRun);
  EXPECT_EQ(runner.RunTo(15).gait, Gait::kWalk);
}

TEST(Driver, WantsNoJumpAnyMoreOnceItWasPutBack) {
  Runner runner(PitAt20());
  ASSERT_EQ(runner.RunTo(19.9).gait, Gait::kJump);
  runner.seen.p_W_m.x() = 16;  // A few metres, as after a failure.
  runner.seen.speed_mps = 0;
  runner.seen.gait = Gait::kStep;
  for (int i = 0; i < 100; ++i) {
    runner.seen.time_s += 0.01;
    EXPECT_NE(runner.driver.Want(runner.seen).gait, Gait::kJump) << i;
  }
  runner.seen.gait = Gait::kRun;
  runner.seen.speed_mps = 2.5;
  EXPECT_EQ(runner.RunTo(19.9).gait, Gait::kJump);  // And again before the pit.
}

TEST(Driver, LearnsToBeginAJumpEarlierWhereTheCharacterAnswersLate) {
  JumpTiming timing(0.4, 0.4, 0, 1);
  const double before_s = timing.LeadS(Gait::kRun);
  timing.Begin(10, Gait::kRun);
  timing.See(11, Gait::kRun);
  EXPECT_TRUE(timing.waits());
  timing.See(11.4, Gait::kJump);  // After 1.4 s, in place of 0.4.
  EXPECT_FALSE(timing.waits());
  EXPECT_NEAR(timing.LeadS(Gait::kRun), before_s + 0.4, 1e-9);  // 0.4 of the surprise.
  EXPECT_NEAR(timing.LeadS(Gait::kWalk), before_s, 1e-9);
}

TEST(Driver, DoesTheTaskAtTheMarkAndGoesOnWhenItIsDone) {
  Runner runner(StopAt20());
  runner.seen.trial.task = 0;
  runner.seen.trial.task_phase = stream::TaskPhase::kAhead;
  EXPECT_EQ(runner.RunTo(15).gait, Gait::kWalk);
  runner.seen.trial.task_phase = stream::TaskPhase::kDue;
  EXPECT_EQ(runner.RunTo(21.5).gait, Gait::kStep);
  runner.seen.trial.task_phase = stream::TaskPhase::kDone;
  EXPECT_EQ(runner.RunTo(24).gait, Gait::kRun);
}

TEST(Driver, StandsWithoutATrackAndWhenTheTrialIsOver) {
  Runner runner(StopAt20());
  runner.seen.trial.phase = stream::TrialPhase::kFinished;
  EXPECT_EQ(runner.RunTo(5).gait, Gait::kStep);
  runner.seen.trial.phase = stream::TrialPhase::kReady;
  EXPECT_EQ(runner.RunTo(8).gait, Gait::kRun);
  EXPECT_EQ(Runner(stream::Track{}).RunTo(5).gait, Gait::kStep);
}

TEST(Driver, MovesFasterAsLongAsTheCharacterIsSlowerThanWanted) {
  Runner slow(Straight({{200, false}})), fast(Straight({{200, false}}));
  slow.seen.speed_mps = 1.9;
  fast.seen.speed_mps = 3.4;
  EXPECT_GT(slow.RunTo(10).effort, fast.RunTo(10).effort + 0.1);
}

TEST(Driver, StylesAreDrawnFromTheSeedWithinTheirRanges) {
  EXPECT_EQ(DrawStyle(3).reaction_s, DrawStyle(3).reaction_s);
  EXPECT_NE(DrawStyle(3).reaction_s, DrawStyle(4).reaction_s);
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const Style style = DrawStyle(seed);
    EXPECT_GE(style.reaction_s, 0.2);
    EXPECT_LE(style.reaction_s, 0.4);
  }
}

}  // namespace
}  // namespace footing::users
