#include "common/virtual/people/driver.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "common/base/units.h"
#include "common/virtual/people/style.h"

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

/// Knows that a second passes until the top of a leap, which is to be 0.2 m high; hits every
/// moment.
JumpHabit Practised() {
  Ability ability;
  ability.run_jump_s = ability.walk_jump_s = 1;
  ability.jump_height_m = 0.2;
  return JumpHabit(ability, 0, 1);
}

/// A jump of a run at 2 m/s towards a pit with its middle at 20 m: it begins at 18 m, the character
/// leaps so that its COM is highest, `height_m` up, at `top_m`.
void Leap(JumpHabit& timing, double top_m, double height_m = 0.2) {
  timing.Begin(10, Gait::kRun, 2, 20);
  EXPECT_TRUE(timing.waits());
  for (double x_m = 18; x_m < top_m + 0.4; x_m += 0.02) {
    const double off_m = std::fabs(x_m - top_m);
    const Gait gait = off_m < 0.3 ? Gait::kJump : Gait::kRun;
    timing.See(10 + (x_m - 18) / 2, gait, x_m, 1 + height_m * std::max(0.0, 1 - off_m / 0.3));
  }
  EXPECT_FALSE(timing.waits());
}

TEST(JumpHabit, WhoLeaptTooEarlyBeginsLaterAndTheOtherWayRound) {
  JumpHabit timing = Practised();
  Leap(timing, 20);
  EXPECT_NEAR(timing.LeadS(Gait::kRun), 1, 0.005);
  Leap(timing, 19.5);  // 0.25 s before the pit's middle, of which 0.3 are learned.
  EXPECT_NEAR(timing.LeadS(Gait::kRun), 1 - 0.3 * 0.25, 0.01);
  JumpHabit late = Practised();
  Leap(late, 20.5);
  EXPECT_NEAR(late.LeadS(Gait::kRun), 1 + 0.3 * 0.25, 0.01);
  EXPECT_EQ(late.LeadS(Gait::kWalk), 1);
}

TEST(JumpHabit, WhoLeaptTooLowMovesMoreWidely) {
  JumpHabit timing = Practised();
  Leap(timing, 20, 0.3);
  EXPECT_EQ(timing.size(), 1);
  Leap(timing, 20, 0.15);
  EXPECT_NEAR(timing.size(), 1.1, 0.03);  // 0.3 of a third.
  for (int i = 0; i < 20; ++i) Leap(timing, 20, 0.1);
  EXPECT_GT(timing.size(), 1.5);
  EXPECT_LT(timing.size(), 1.7);  // A hand swings no farther.
}

TEST(JumpHabit, WhoHasSeenNoLeapBeforeTheFallWasTooLate) {
  JumpHabit begun = Practised(), none = Practised(), leapt = Practised();
  begun.Begin(10, Gait::kWalk, 1, 20);
  begun.Fail(Gait::kWalk);
  EXPECT_GT(begun.LeadS(Gait::kWalk), 1.1);
  none.Fail(Gait::kRun);  // Ran into it.
  EXPECT_GT(none.LeadS(Gait::kRun), 1.1);
  Leap(leapt, 19);
  const double learned_s = leapt.LeadS(Gait::kRun);
  leapt.Fail(Gait::kRun);  // The leap before the pit was seen, and is learned from once.
  EXPECT_EQ(leapt.LeadS(Gait::kRun), learned_s);
}

/// Out of a walk a small hop comes before the leap.
TEST(JumpHabit, LearnsFromTheLeapAndNotFromTheHopBeforeIt) {
  JumpHabit timing = Practised();
  timing.Begin(10, Gait::kWalk, 1, 20);
  const double heights_m[] = {1, 1.03, 1.05, 1.02, 0.98, 1.1, 1.2, 1.1, 1};
  for (int i = 0; i < 9; ++i) timing.See(10.5 + 0.1 * i, Gait::kJump, 19.4 + 0.1 * i, heights_m[i]);
  timing.See(11.5, Gait::kWalk, 20.4, 1);
  EXPECT_NEAR(timing.LeadS(Gait::kWalk), 1, 1e-6);  // The top was at 20 m.
}

TEST(Driver, NoRunUpIsLikeTheOneBefore) {
  Runner runner(PitAt20());
  const double first_mps = runner.RunTo(12).speed_mps;
  EXPECT_EQ(runner.RunTo(14).speed_mps, first_mps);
  runner.seen.p_W_m.x() = 8;  // Put back.
  const double second_mps = runner.RunTo(12).speed_mps;
  EXPECT_NE(second_mps, first_mps);
  EXPECT_NEAR(second_mps, first_mps, 0.15 * first_mps);
}

TEST(Driver, JumpsAgainAtOnceWhenASingleLeapCameDownBeforeThePit) {
  Ability ability = DirectAbility();
  ability.jumps_at_once = true;
  Runner runner(PitAt20(), ability);
  while (runner.RunTo(runner.seen.p_W_m.x() + 0.02).gait != Gait::kJump) {
  }
  ASSERT_LT(runner.seen.p_W_m.x(), 18.5);
  runner.seen.speed_mps = 1;
  runner.seen.gait = Gait::kJump;
  EXPECT_NE(runner.RunTo(19).gait, Gait::kJump);  // It was seen.
  runner.seen.gait = Gait::kWalk;
  EXPECT_EQ(runner.RunTo(19.6).gait, Gait::kJump);
}

TEST(Driver, RunsUpToAPitAlthoughABendLiesBehindIt) {
  stream::Track track = Straight({{20, false}, {0.5, true}, {3, false}, {30, false}});
  track.segments[3].heading_rad = 1.2;
  Runner runner(track);
  EXPECT_EQ(runner.RunTo(17).gait, Gait::kRun);
  stream::Track without = Straight({{20, false}, {0.5, false}, {3, false}, {30, false}});
  without.segments[3].heading_rad = 1.2;
  EXPECT_EQ(Runner(without).RunTo(18.5).gait, Gait::kWalk);
}

/// Nobody crosses a wide pit without a run-up.
TEST(Driver, RunsUpToAPitWithABendAtItsFarEdge) {
  stream::Track track = Straight({{20, false}, {1, true}, {20, false}});
  track.segments[2].heading_rad = 0.5;
  Ability ability = DirectAbility();
  ability.turn_per_step_rad = DegreesToRadians(5);
  Runner runner(track, ability);
  EXPECT_EQ(runner.RunTo(17.5).gait, Gait::kRun);
  EXPECT_EQ(runner.RunTo(19.9).gait, Gait::kJump);
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
    EXPECT_EQ(style.left_grip_rad, 0);
  }
}

TEST(Driver, EachHandHasItsOwnGripAsWideAsTheInterfaceLetsIt) {
  for (const auto interface : stream::kUserInterfaces) {
    const double most_rad = MostGrip(interface);
    double least_rad = 0, widest_rad = 0;
    int alike = 0;
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
      const Style style = DrawStyle(seed, interface);
      EXPECT_EQ(style.reaction_s, DrawStyle(seed).reaction_s);
      for (const double grip_rad : {style.left_grip_rad, style.right_grip_rad}) {
        EXPECT_LE(std::fabs(grip_rad), most_rad);
        least_rad = std::min(least_rad, grip_rad);
        widest_rad = std::max(widest_rad, grip_rad);
      }
      alike += style.left_grip_rad * style.right_grip_rad > 0;
    }
    EXPECT_LE(least_rad, -0.9 * most_rad);
    EXPECT_GE(widest_rad, 0.9 * most_rad);
    EXPECT_NEAR(alike, most_rad > 0 ? 100 : 0, 30) << stream::Name(interface);
  }
}

TEST(Grip, IsAsWishedOrAsDrawn) {
  const auto mirrored = ParseGrip(45, "mirrored", stream::UserInterface::kArm);
  const auto same = ParseGrip(45, "same", stream::UserInterface::kWrist);
  ASSERT_TRUE(mirrored && same);
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    const Style apart = StyleOf(seed, stream::UserInterface::kArm, *mirrored);
    const Style alike = StyleOf(seed, stream::UserInterface::kWrist, *same);
    EXPECT_NEAR(std::fabs(apart.left_grip_rad), DegreesToRadians(45), 1e-12);
    EXPECT_EQ(apart.left_grip_rad, -apart.right_grip_rad);
    EXPECT_EQ(alike.left_grip_rad, alike.right_grip_rad);
    EXPECT_EQ(StyleOf(seed, stream::UserInterface::kArm, {}).left_grip_rad,
              DrawStyle(seed, stream::UserInterface::kArm).left_grip_rad);
  }
  EXPECT_FALSE(ParseGrip(45, "askew", stream::UserInterface::kArm));
  EXPECT_FALSE(ParseGrip(120, "same", stream::UserInterface::kArm));
  EXPECT_FALSE(ParseGrip(45, "same", stream::UserInterface::kBoards));
}

}  // namespace
}  // namespace footing::users
