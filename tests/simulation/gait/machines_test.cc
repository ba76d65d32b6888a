#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <sstream>
#include <utility>

#include "common/config/data_file.h"
#include "daemon/simulation/gait/limits.h"
#include "daemon/simulation/gait/phase.h"
#include "daemon/simulation/gait/transition.h"

namespace footing::gait {
namespace {

using stream::Gait;
constexpr Gait kGaits[] = {Gait::kStep, Gait::kWalk, Gait::kRun, Gait::kJump};

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

TEST(Machines, AreDrawnInTheirDocumentAsTheyAre) {
  using Drawn = std::set<std::pair<std::string, std::string>>;
  const auto word = [](std::string name) {
    std::replace(name.begin(), name.end(), ' ', '_');
    return name;
  };
  Drawn expected, drawn;
  for (const auto& [from, to] : WalkingArrows())
    expected.insert({word(Name(from)), word(Name(to))});
  for (const auto& [from, to] : RunningArrows())
    expected.insert({word(Name(from)), word(Name(to))});
  const auto text = config::ReadTextFile(FOOTING_SOURCE_DIR "/docs/gait.md");
  ASSERT_TRUE(text.ok());
  std::istringstream lines(text.value());
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string from, arrow, to;
    if (words >> from >> arrow >> to && arrow == "-->")
      drawn.insert({from, to.substr(0, to.find(':'))});
  }
  EXPECT_EQ(drawn, expected);
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
  EXPECT_EQ(Limited({.gait = Gait::kJump, .height_m = 3}).height_m, 0.7);
  EXPECT_EQ(Limited({.gait = Gait::kJump, .speed_mps = 2, .height_m = 3}).height_m, 0.5);
  EXPECT_EQ(Limited({.gait = Gait::kRun, .speed_mps = NAN}).gait, Gait::kStep);
  EXPECT_EQ(Limited({.gait = Gait::kUnspecified, .speed_mps = 1}).gait, Gait::kStep);
}

}  // namespace
}  // namespace footing::gait
