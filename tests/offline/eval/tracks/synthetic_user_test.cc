#include "daemon/offline/eval/tracks/synthetic_user.h"

#include <gtest/gtest.h>

#include "daemon/simulation/terrain/track.h"

namespace footing::eval {
namespace {

using stream::Gait;

constexpr const char* kPitAt20 = R"({"version": 1, "help_over_pits": false, "segments": [
  {"length_m": 20}, {"length_m": 0.5, "pit": true}, {"length_m": 20}]})";
constexpr const char* kTaskAt20 = R"({"version": 1, "segments": [{"length_m": 60}],
  "mark": {"at_m": 20, "tasks": [{"name": "stop", "before": "walk", "after": "step"}]}})";

/// A character that runs along x as the user sees it, every 10 ms.
struct Runner {
  stream::Track track;
  SyntheticUser user;
  Sight sight;

  explicit Runner(const char* text)
      : track(terrain::ParseTrack(text, "track").value()), user(track, Skill{}, Random(7)) {
    sight.gait = Gait::kRun;
    sight.speed_mps = 2.5;
  }

  /// Until x; returns what was wanted last.
  biped::GaitCommand RunTo(double x_m) {
    biped::GaitCommand wanted;
    while (sight.p_W_m.x() < x_m) {
      sight.time_s += 0.01;
      sight.p_W_m.x() += 0.01 * sight.speed_mps;
      wanted = user.Want(sight);
    }
    return wanted;
  }
};

TEST(SyntheticUser, JumpsBeforeAPitAndRunsOnBehindIt) {
  Runner runner(kPitAt20);
  EXPECT_EQ(runner.RunTo(16).gait, Gait::kRun);
  EXPECT_EQ(runner.RunTo(19.9).gait, Gait::kJump);
  EXPECT_EQ(runner.RunTo(22.5).gait, Gait::kRun);
}

TEST(SyntheticUser, WantsNoJumpAnyMoreOnceItWasPutBack) {
  Runner runner(kPitAt20);
  ASSERT_EQ(runner.RunTo(19.9).gait, Gait::kJump);
  runner.sight.p_W_m.x() = 17;  // A few metres, as after a failure.
  runner.sight.put_backs = 1;
  runner.sight.speed_mps = 0;
  runner.sight.gait = Gait::kStep;
  for (int i = 0; i < 100; ++i) {
    runner.sight.time_s += 0.01;
    EXPECT_NE(runner.user.Want(runner.sight).gait, Gait::kJump) << i;
  }
  runner.sight.gait = Gait::kRun;
  runner.sight.speed_mps = 2.5;
  EXPECT_EQ(runner.RunTo(19.9).gait, Gait::kJump);  // And again before the pit.
}

TEST(SyntheticUser, DoesTheTaskAtTheMarkAndGoesOnWhenItIsDone) {
  Runner runner(kTaskAt20);
  runner.sight.task = 0;
  runner.sight.task_phase = stream::TaskPhase::kAhead;
  EXPECT_EQ(runner.RunTo(15).gait, Gait::kWalk);
  runner.sight.task_phase = stream::TaskPhase::kDue;
  EXPECT_EQ(runner.RunTo(20.5).gait, Gait::kStep);
  runner.sight.task_phase = stream::TaskPhase::kDone;
  EXPECT_EQ(runner.RunTo(22).gait, Gait::kRun);
}

}  // namespace
}  // namespace footing::eval
