#include <gtest/gtest.h>

#include <set>
#include <utility>

#include "daemon/simulation/gait/limits.h"
#include "daemon/simulation/gait/phase.h"
#include "daemon/simulation/gait/transition.h"

namespace footing::gait {
namespace {

using stream::Gait;
constexpr Gait kGaits[] = {Gait::kStep, Gait::kWalk, Gait::kRun, Gait::kJump};

TEST(WalkingMachine, HasTheArrowsOfFigure5AndNoOther) {
  using P = WalkingPhase;
  std::set<std::pair<P, P>> arrows;
  for (const P phase : {P::kDoubleSupport, P::kRise, P::kFall}) {
    for (int cues = 0; cues < 8; ++cues) {
      const P next = Next(phase, {(cues & 1) != 0, (cues & 2) != 0, (cues & 4) != 0});
      if (next != phase) arrows.insert({phase, next});
    }
  }
  EXPECT_EQ(arrows, (std::set<std::pair<P, P>>{{P::kDoubleSupport, P::kRise},
                                               {P::kRise, P::kFall},
                                               {P::kFall, P::kDoubleSupport}}));
}

TEST(RunningMachine, HasTheArrowsOfFigure6AndTheEarlyLanding) {
  using P = RunningPhase;
  std::set<std::pair<P, P>> arrows;
  for (const P phase : {P::kUpwardFlight, P::kDownwardFlight, P::kCompression, P::kExtension}) {
    for (int cues = 0; cues < 32; ++cues) {
      const P next = Next(phase, {(cues & 1) != 0, (cues & 2) != 0, (cues & 4) != 0,
                                  (cues & 8) != 0, (cues & 16) != 0});
      if (next != phase) arrows.insert({phase, next});
    }
  }
  EXPECT_EQ(arrows, (std::set<std::pair<P, P>>{{P::kUpwardFlight, P::kDownwardFlight},
                                               {P::kUpwardFlight, P::kCompression},
                                               {P::kDownwardFlight, P::kCompression},
                                               {P::kCompression, P::kExtension},
                                               {P::kExtension, P::kUpwardFlight}}));
}

TEST(GaitChanges, OnlyJumpingToRunningHasNoArrow) {
  for (const Gait from : kGaits) {
    for (const Gait to : kGaits) {
      EXPECT_EQ(IsDirect(from, to), !(from == Gait::kJump && to == Gait::kRun))
          << Name(from) << " to " << Name(to);
    }
  }
}

TEST(GaitChanges, JumpingReachesRunningByWalking) {
  GaitMemory memory;
  memory.gait = Gait::kJump;
  const biped::GaitCommand run{.gait = Gait::kRun, .speed_mps = 3};
  const TransitionGains gains;
  EXPECT_EQ(Goal(memory, run, gains).gait, Gait::kWalk);
  EXPECT_EQ(Goal(memory, run, gains).speed_mps, gains.jump_speed_before_landing_mps);
  memory.gait = Gait::kStep;
  EXPECT_EQ(Goal(memory, run, gains), run);
}

TEST(Limits, KeepCommandsInTheStableRange) {
  EXPECT_EQ(Limited({.gait = Gait::kWalk, .speed_mps = 9}).speed_mps, 1.75);
  EXPECT_EQ(Limited({.gait = Gait::kRun, .speed_mps = -1}).speed_mps, 0);
  EXPECT_EQ(Limited({.gait = Gait::kJump, .height_m = 3}).height_m, 0.5);
  EXPECT_EQ(Limited({.gait = Gait::kRun, .speed_mps = NAN}).gait, Gait::kStep);
  EXPECT_EQ(Limited({.gait = Gait::kUnspecified, .speed_mps = 1}).gait, Gait::kStep);
}

}  // namespace
}  // namespace footing::gait
