#include <cstdlib>
#include <fstream>
#include <set>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "common/runtime/files.h"
#include "daemon/simulation/biped/body_state.h"
#include "daemon/simulation/engine/engine.h"
#include "daemon/simulation/gait/gain_table.h"
#include "daemon/simulation/gait/transition.h"
#include "tests/simulation/test_world.h"

namespace footing::gait {
namespace {

using stream::Gait;

GainTable Read(const std::string& text) {
  GainTable table;
  const auto added = table.Add(text, "made.csv");
  EXPECT_TRUE(added.ok()) << (added.ok() ? "" : added.error().message);
  return table;
}

GainTable Shipped() {
  GainTable table;
  for (const char* name : engine::kGainFiles) {
    const auto added = table.Add(test::DataFile(name), name);
    EXPECT_TRUE(added.ok()) << (added.ok() ? "" : added.error().message);
  }
  return table;
}

TEST(GainFields, NameEveryNumberOfGainsOnce) {
  // A number of gains.h without a line in gain_fields.cc could not be tuned nor interpolated.
  EXPECT_EQ(GainFields().size() * sizeof(double), sizeof(Gains));
  Gains gains;
  std::set<const double*> places;
  std::set<std::string_view> names;
  for (const GainField& field : GainFields()) {
    places.insert(&field.of(gains));
    names.insert(field.name);
    EXPECT_EQ(FindGain(field.name), &field);
  }
  EXPECT_EQ(places.size(), GainFields().size());
  EXPECT_EQ(names.size(), GainFields().size());
}

TEST(GainFields, AllowTheDefaults) {
  for (const GainField& field : GainFields()) {
    EXPECT_GE(field.Of(Gains{}), field.min) << field.name;
    EXPECT_LE(field.Of(Gains{}), field.max) << field.name;
  }
}

TEST(GainTable, IsTheDefaultsWhenEmpty) {
  const Gains gains = GainTable().At(Gait::kRun, 3);
  for (const GainField& field : GainFields()) {
    EXPECT_EQ(field.Of(gains), field.Of(Gains{})) << field.name;
  }
}

TEST(GainTable, InterpolatesBetweenSlowAndFastAndHoldsBeyond) {
  const GainTable table = Read(
      "# a comment\n\n"
      "gait,set,speed_mps,attitude.roll_damping_nms_per_rad,walking.step_width_m\r\n"
      "-, -, m/s, N m s/rad, m\n"
      "walk,slow,0.5,60,0.2\n"
      "walk,fast,1.5,80,0.3\n");
  const auto roll = [&table](double speed_mps) {
    return table.At(Gait::kWalk, speed_mps).attitude.roll_damping_nms_per_rad;
  };
  EXPECT_EQ(roll(-1), 60);
  EXPECT_EQ(roll(0.5), 60);
  EXPECT_NEAR(roll(0.75), 65, 1e-12);
  EXPECT_EQ(roll(1.5), 80);
  EXPECT_EQ(roll(9), 80);
  EXPECT_EQ(table.At(Gait::kWalk, 0.7).walking.swing_time_s, Gains{}.walking.swing_time_s);
  EXPECT_EQ(table.At(Gait::kStep, 0.7).attitude.roll_damping_nms_per_rad,
            Gains{}.attitude.roll_damping_nms_per_rad);
}

TEST(GainTable, GivesOneLegsLawsToTheGaitsThatLeadThere) {
  const GainTable table = Read(
      "gait,set,speed_mps,hopping.run_leg_stiffness_n_per_m,walking.hip_height_m\n"
      "-,-,m/s,N/m,m\n"
      "walk,all,0,1000,0.9\n"
      "run,all,0,5000,0.8\n");
  EXPECT_EQ(table.At(Gait::kWalk, 1).hopping.run_leg_stiffness_n_per_m, 5000);
  EXPECT_EQ(table.At(Gait::kWalk, 1).walking.hip_height_m, 0.9);
  EXPECT_EQ(table.At(Gait::kRun, 1).hopping.run_leg_stiffness_n_per_m, 5000);
  EXPECT_EQ(table.At(Gait::kJump, 1).walking.hip_height_m, 0.9);
}

TEST(GainTable, ALaterFileReplacesTheGaitsItNames) {
  GainTable table = Shipped();
  ASSERT_TRUE(table.Add("gait,set,speed_mps\n-,-,m/s\nrun,all,0\n", "later.csv").ok());
  EXPECT_EQ(table.SetsOf(Gait::kRun).size(), 1u);
  EXPECT_EQ(table.SetsOf(Gait::kWalk).size(), Shipped().SetsOf(Gait::kWalk).size());
}

TEST(GainTable, WritesWhatItReads) {
  std::vector<GainSet> sets{{"slow", 1.25, {}}, {"fast", 4, {}}};
  sets[0].gains.servo.hip_damping_nms_per_rad = 21.123456789012345;
  std::vector<const GainField*> columns;
  for (const GainField& field : GainFields()) columns.push_back(&field);
  const std::string text = WriteGains(Gait::kRun, sets, columns, "One line.\nAnother.");
  EXPECT_EQ(text.substr(0, 24), "# One line.\n# Another.\ng");
  const GainTable table = Read(text);
  ASSERT_EQ(table.SetsOf(Gait::kRun).size(), 2u);
  EXPECT_EQ(table.SetsOf(Gait::kRun)[0].name, "slow");
  for (const GainField& field : GainFields()) {
    EXPECT_EQ(field.Of(table.At(Gait::kRun, 1.25)), field.Of(sets[0].gains)) << field.name;
  }
}

TEST(GainTable, NamesFileLineAndFaultOfWhatItCannotRead) {
  const std::string names = "gait,set,speed_mps,walking.step_width_m\n";
  const std::string units = "-,-,m/s,m\n";
  const struct {
    std::string text, fault;
  } rows[] = {
      {"", "made.csv: needs a row of names"},
      {names + units, "needs a row of names, one of units and one a set; has 2 rows"},
      {"gait,speed_mps\n", "made.csv, line 1: the columns must begin with gait,set,speed_mps"},
      {"gait,set,speed_mps,walking.step\n", "made.csv, line 1: unknown gain 'walking.step'"},
      {"gait,set,speed_mps,walking.step_width_m,walking.step_width_m\n", "has two columns"},
      {names + "-,-,m/s,cm\n",
       "made.csv, line 2: the unit of walking.step_width_m is 'cm', must be"},
      {names + units + "walk,slow,0.5\n", "made.csv, line 3: 3 cells where 4 columns are named"},
      {names + units + "hop,slow,0.5,0.2\n",
       "made.csv, line 3: gait is 'hop', must be one of step, walk, run, jump"},
      {names + units + "walk,,0.5,0.2\n", "the set has no name"},
      {names + units + "walk,slow,fast,0.2\n", "speed_mps is 'fast', which is not a number"},
      {names + units + "walk,slow,0.5,nan\n", "step_width_m is 'nan', which is not a number"},
      {names + units + "walk,slow,0.5,3\n", "walking.step_width_m is 3, allowed is 0 to 1"},
      {names + units + "walk,a,1,0.2\nwalk,b,1,0.2\n", "made.csv, line 4: speed_mps is 1 after 1"},
  };
  for (const auto& row : rows) {
    GainTable table;
    const auto added = table.Add(row.text, "made.csv");
    ASSERT_FALSE(added.ok()) << row.text;
    EXPECT_EQ(added.error().kind, ErrorKind::kInvalidData);
    EXPECT_NE(added.error().message.find(row.fault), std::string::npos)
        << added.error().message << "\nexpected: " << row.fault;
  }
}

TEST(ShippedGains, SayOnlyWhatDiffersFromTheHeader) {
  // One place for each number: a table that repeated a default would hide a change of gains.h.
  std::vector<const char*> names(engine::kGainFiles.begin(), engine::kGainFiles.end());
  names.insert(names.end(), engine::kStyleFiles.begin(), engine::kStyleFiles.end());
  for (const char* name : names) {
    GainTable table;
    const std::string text = test::DataFile(name);
    ASSERT_TRUE(table.Add(text, name).ok());
    const std::size_t header = text.find("gait,set,speed_mps");
    const std::string columns = text.substr(header, text.find('\n', header) - header);
    for (const GainField& field : GainFields()) {
      bool differs = false;
      for (const Gait gait : stream::kGaits) {
        for (const GainSet& set : table.SetsOf(gait)) {
          differs = differs || field.Of(set.gains) != field.Of(Gains{});
        }
      }
      const bool named =
          (columns + ",").find("," + std::string(field.name) + ",") != std::string::npos;
      EXPECT_EQ(named, differs) << name << ": " << field.name;
    }
  }
}

TEST(PrototypeGains, AreStillATableToCompareWith) {
  const auto text = config::ReadTextFile(FOOTING_SOURCE_DIR "/tests/simulation/gait/prototype.csv");
  ASSERT_TRUE(text.ok());
  EXPECT_EQ(Read(*text).At(Gait::kRun, 5).hopping.run_velocity_gain_s, 0.06);
}

TEST(Between, IsTheOneAndTheOtherAtItsEnds) {
  Gains a, b;
  b.walking.swing_time_s = 0.6;
  EXPECT_EQ(Between(a, b, 0).walking.swing_time_s, a.walking.swing_time_s);
  EXPECT_EQ(Between(a, b, 1).walking.swing_time_s, 0.6);
  EXPECT_DOUBLE_EQ(Between(a, b, 0.25).walking.swing_time_s, 0.75 * 0.32 + 0.25 * 0.6);
}

TEST(ShippedGains, HaveSetsForEveryGait) {
  for (const Gait gait : stream::kGaits) {
    EXPECT_FALSE(Shipped().SetsOf(gait).empty()) << stream::Name(gait);
  }
}

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

// After a change of the tables FOOTING_WRITE_FIGURES=1 build/release/tests/test_simulation_gait
// writes them.
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
