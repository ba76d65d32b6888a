#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "clients/study/plan/meter.h"
#include "common/board/geometry.h"
#include "common/runtime/files.h"
#include "common/virtual/people/person.h"
#include "daemon/simulation/mapping/any_interface.h"
#include "tests/clients/study/range_acts.h"

namespace footing::study::ranges {
namespace {

using stream::Gait;
using stream::UserInterface;
using testing::HasSubstr;
using users::Act;

const Played kBoards{"boards"};

std::vector<Act> BoardMotions(double gentle = 0.5) {
  std::vector<Act> acts = users::RangeActs(UserInterface::kBoards);
  for (Act& act : acts) act.wanted.size = std::max(gentle, act.wanted.size);
  return acts;
}
constexpr std::size_t kFirstRise = 2, kLeans = 15;  ///< Where in the acts these begin.

Meter MeterOf(const users::Style& style, const std::vector<Act>& acts) {
  Meter meter(kBoards);
  users::Person person(UserInterface::kBoards, style, 1);
  double begin_s = 0;
  for (const Act& act : acts) {
    for (double t_s = 0; t_s < act.duration_s; t_s += kPeriodS) {
      person.Advance(begin_s + t_s, act.wanted);
      const auto foot = [&person](std::size_t side) {
        const virtual_sensors::FootForce& force = person.felt().feet[side];
        return board::FootLoad{force.load_n, force.load_n > board::kContactOffN, force.cop_m.x()};
      };
      meter.AddStance(begin_s + t_s, board::StanceOn(foot(0), foot(1)), true);
    }
    begin_s += act.duration_s;
  }
  return meter;
}

std::string BuiltIn() { return *config::ReadDataFile("boards_mapping.json"); }

Result<nlohmann::ordered_json> TableOf(const Meter& meter) {
  const auto ranges = meter.Measure();
  if (!ranges) return ranges.error();
  Provenance provenance;
  provenance.participants = {"P01"};
  return TableOf(kBoards, *ranges, provenance, BuiltIn());
}

TEST(BoardRanges, FollowTheTrueRangeOfUsersOfDifferentTempoAndAmplitude) {
  // The synthetic user at tempo and amplitude 1 (common/virtual/people/person.cc).
  constexpr double kSlowHz = 0.55, kFastHz = 2.0;
  constexpr double kStepLean = 2 * 0.05 / 0.336, kStandLean = 1.5 * kStepLean;
  // The largest second derivative of the smoothest way of 7 cm in 0.3 s, over g.
  constexpr double kRise = 5.77 * 0.07 / (0.3 * 0.3) / 9.80665;
  for (const auto& [tempo, amplitude] : {std::pair{0.85, 0.8}, {1.0, 1.0}, {1.15, 1.2}}) {
    const auto table = TableOf(MeterOf(StyleOf(tempo, amplitude), BoardMotions()));
    ASSERT_TRUE(table) << tempo << ": " << table.error().message;
    EXPECT_NEAR((*table)["walk_frequency_min_hz"], tempo * kSlowHz, 0.08 * kSlowHz);
    EXPECT_NEAR((*table)["run_frequency_max_hz"], tempo * kFastHz, 0.08 * kFastHz);
    EXPECT_NEAR((*table)["turn_above"], 0.625 * amplitude * kStepLean, 0.15 * kStepLean);
    EXPECT_NEAR((*table)["standing_turn_above"], 0.625 * amplitude * kStandLean, 0.1 * kStandLean);
    EXPECT_NEAR((*table)["jump_overshoot_max"], amplitude * kRise, 0.12 * kRise);
    EXPECT_NEAR((*table)["jump_overshoot_min"], 0.5 * amplitude * kRise, 0.12 * kRise);
    const auto made =
        mapping::AnyInterface::Create({.interface = UserInterface::kBoards}, table->dump());
    EXPECT_TRUE(made) << made.error().message;
  }
}

TEST(BoardRanges, CountAGentleRiseThatTheBuiltInTableWouldMiss) {
  Ranges ranges{{quantity::kFootHz, {0.5, 2, 9}},
                {quantity::kRiseShare, {0.1, 0.3, 2}},
                {quantity::kStepLean, {-0.3, 0.3, 9}},
                {quantity::kStandLean, {-0.5, 0.5, 6}}};
  auto table = TableOf(kBoards, ranges, {}, BuiltIn());
  ASSERT_TRUE(table);
  EXPECT_EQ((*table)["heel_rise_overshoot"], 0.08);  // 0.8 of 0.1; built in 0.12.
  ranges[quantity::kRiseShare].low = 0.25;
  table = TableOf(kBoards, ranges, {}, BuiltIn());
  ASSERT_TRUE(table);
  EXPECT_EQ((*table)["heel_rise_overshoot"], 0.12);
  // Nobody turns by a lean of standing that is not meant.
  ranges[quantity::kStandLean] = {-0.31, 0.4, 6};
  table = TableOf(kBoards, ranges, {}, BuiltIn());
  ASSERT_TRUE(table);
  EXPECT_EQ((*table)["standing_turn_above"], 0.22);
}

TEST(BoardRanges, RefuseAMotionThatWasTooSmallTooShortOrNotVaried) {
  const auto says = [](const std::vector<Act>& acts, double amplitude = 1) {
    const auto table = TableOf(MeterOf(StyleOf(1, amplitude), acts));
    return table ? std::string("none") : table.error().message;
  };
  EXPECT_THAT(says(BoardMotions(1)), HasSubstr("rise gently"));
  auto acts = BoardMotions();
  acts.erase(acts.begin() + kFirstRise, acts.begin() + kLeans);
  EXPECT_THAT(says(acts), HasSubstr("on the toes"));
  acts = BoardMotions();
  acts[1].wanted = {.gait = Gait::kWalk, .effort = 0.05};
  acts.erase(acts.begin() + kLeans, acts.begin() + kLeans + 2);
  EXPECT_THAT(says(acts), HasSubstr("slower first"));
  acts = BoardMotions();
  acts[kLeans + 1].wanted.turn_rad = 0.1;  // To the left twice.
  EXPECT_THAT(says(acts), HasSubstr("while you step"));
  acts = BoardMotions();
  acts[kLeans + 3].wanted.turn_rad = 0.1;
  EXPECT_THAT(says(acts), HasSubstr("on both feet"));
  acts = BoardMotions();
  acts.erase(acts.begin() + kLeans, acts.begin() + kLeans + 2);
  acts.erase(acts.begin(), acts.begin() + kFirstRise);
  EXPECT_THAT(says(acts), HasSubstr("stepping in place"));
}

TEST(BoardRanges, NameTheBoardsThatAreMissing) {
  const auto ranges = Meter(kBoards).Measure();
  ASSERT_FALSE(ranges);
  EXPECT_EQ(ranges.error().kind, ErrorKind::kNoDevice);
  EXPECT_THAT(ranges.error().message, HasSubstr("left_board, right_board"));
}

}  // namespace
}  // namespace footing::study::ranges
