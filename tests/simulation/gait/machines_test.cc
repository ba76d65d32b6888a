#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <set>
#include <utility>

#include "common/runtime/data_file.h"
#include "daemon/simulation/biped/limits.h"
#include "daemon/simulation/gait/phase.h"
#include "daemon/simulation/gait/transition.h"

namespace footing::gait {
namespace {

using stream::Gait;
using stream::kGaits;

/// Every arrow from `phases` that some combination of the cues takes.
template <typename Cues, typename Phase>
std::set<std::pair<Phase, Phase>> Arrows(std::initializer_list<Phase> phases) {
  std::set<std::pair<Phase, Phase>> arrows;
  static_assert(sizeof(Cues) <= 5, "all cues are flags");
  for (const Phase phase : phases) {
    for (int bits = 0; bits < 1 << sizeof(Cues); ++bits) {
      Cues cues;
      auto* flags = reinterpret_cast<bool*>(&cues);
      for (std::size_t i = 0; i < sizeof(Cues); ++i) flags[i] = (bits >> i & 1) != 0;
      const Phase next = Next(phase, cues);
      if (next != phase) arrows.insert({phase, next});
    }
  }
  return arrows;
}

auto WalkingArrows() {
  using P = WalkingPhase;
  return Arrows<WalkingCues>({P::kDoubleSupport, P::kRise, P::kFall});
}

auto RunningArrows() {
  using P = RunningPhase;
  return Arrows<RunningCues>(
      {P::kUpwardFlight, P::kDownwardFlight, P::kCompression, P::kExtension});
}

TEST(WalkingMachine, HasTheArrowsOfFigure5AndNoOther) {
  using P = WalkingPhase;
  EXPECT_EQ(WalkingArrows(), (std::set<std::pair<P, P>>{{P::kDoubleSupport, P::kRise},
                                                        {P::kRise, P::kFall},
                                                        {P::kFall, P::kDoubleSupport}}));
}

TEST(RunningMachine, HasTheArrowsOfFigure6AndTheEarlyLanding) {
  using P = RunningPhase;
  EXPECT_EQ(RunningArrows(), (std::set<std::pair<P, P>>{{P::kUpwardFlight, P::kDownwardFlight},
                                                        {P::kUpwardFlight, P::kCompression},
                                                        {P::kDownwardFlight, P::kCompression},
                                                        {P::kCompression, P::kExtension},
                                                        {P::kExtension, P::kUpwardFlight}}));
}

// After a change of the tables: FOOTING_WRITE_FIGURES=1 tests/test_simulation_gait writes them
// anew.
TEST(Machines, AreDrawnInTheirDocumentFromTheirTables) {
  const std::string path = FOOTING_SOURCE_DIR "/docs/gait.md";
  const auto document = config::ReadTextFile(path);
  ASSERT_TRUE(document.ok());
  std::string text = document.value();
  const std::string fence = "```mermaid\n";
  std::size_t at = 0;
  for (const std::string& figure :
       {DrawWalkingMachine(), DrawRunningMachine(), DrawGaitChanges()}) {
    at = text.find(fence, at);
    ASSERT_NE(at, std::string::npos) << "docs/gait.md must hold three figures";
    at += fence.size();
    text.replace(at, text.find("```", at) - at, figure);
  }
  if (std::getenv("FOOTING_WRITE_FIGURES") != nullptr) std::ofstream(path) << text;
  EXPECT_EQ(text, document.value()) << "docs/gait.md draws the machines otherwise than they are";
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
  EXPECT_EQ(Goal(memory, run, gains, 0).gait, Gait::kWalk);
  EXPECT_EQ(Goal(memory, run, gains, 0).speed_mps, gains.jump_speed_before_landing_mps);
  memory.gait = Gait::kStep;
  EXPECT_EQ(Goal(memory, run, gains, 0), run);
}

TEST(GaitChanges, ABrakingRunTurnsAsItsSpeedAllows) {
  GaitMemory memory;
  memory.gait = Gait::kRun;
  memory.speed.desired_mps = 6;
  const biped::GaitCommand slow{.gait = Gait::kRun, .speed_mps = 2, .turn_per_step_rad = -0.13};
  EXPECT_EQ(Goal(memory, slow, {}, 2).turn_per_step_rad, -biped::TurnLimit(Gait::kRun, 6));
  memory.speed.desired_mps = 2;
  EXPECT_EQ(Goal(memory, slow, {}, 2).turn_per_step_rad, -0.13);
}

TEST(GaitChanges, ALeapTurnsAsTheSpeedOfItsRunAllows) {
  GaitMemory memory;
  memory.gait = Gait::kJump;  // v_d is the jump's by the time that the leap lands.
  const biped::GaitCommand jump{.gait = Gait::kJump, .speed_mps = 1, .turn_per_step_rad = 0.13};
  EXPECT_EQ(Goal(memory, jump, {}, 4).turn_per_step_rad, biped::TurnLimit(Gait::kJump, 4));
  EXPECT_EQ(Goal(memory, jump, {}, 1).turn_per_step_rad, 0.13);
}

}  // namespace
}  // namespace footing::gait
