#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "clients/study/plan/meter.h"
#include "common/base/units.h"
#include "common/runtime/files.h"
#include "common/virtual/people/person.h"
#include "daemon/offline/analysis/features_chain.h"
#include "daemon/simulation/mapping/any_interface.h"
#include "tests/clients/study/range_acts.h"

namespace footing::study::ranges {
namespace {

using stream::Gait;
using stream::UserInterface;
using testing::HasSubstr;
using users::Act;

constexpr double kMostMps2 = 33;  // Range of a Wiimote: a little over 3 g.

std::vector<Act> Motions(UserInterface interface = UserInterface::kWrist) {
  return users::RangeActs(interface);
}

/// Measures a user through the code of footingd.
Meter MeterOf(UserInterface interface, const users::Style& style, const std::vector<Act>& acts,
              const Played& played) {
  const bool leg = interface == UserInterface::kLeg;
  using stream::DeviceRole;
  std::vector<features::Member> members{{1, leg ? DeviceRole::kLeftLeg : DeviceRole::kLeftHand},
                                        {2, leg ? DeviceRole::kRightLeg : DeviceRole::kRightHand}};
  if (leg) members.push_back({3, DeviceRole::kHead});
  eval::Chain chain(members);
  Meter meter(played);
  double begin_s = 0;
  for (const Act& act : acts) {
    users::Person person(interface, style, 1);
    for (double t_s = 0; t_s < act.duration_s; t_s += kPeriodS) {
      person.Advance(t_s, act.wanted);
      const auto at_ns = static_cast<std::int64_t>(1e9 * (begin_s + t_s + kPeriodS));
      for (std::uint32_t i = 0; i < members.size(); ++i) {
        const Eigen::Vector3d felt = person.felt().remotes[i].specific_force_S_mps2;
        const Eigen::Vector3d sent = felt.cwiseMax(-kMostMps2).cwiseMin(kMostMps2);
        std::uint32_t clipped = 0;
        for (int axis = 0; axis < 3; ++axis) clipped |= sent[axis] != felt[axis] ? 1u << axis : 0;
        chain.Add(i + 1, at_ns, sent, clipped);
      }
      meter.Add(begin_s + t_s, chain.Compute(at_ns), 0);
    }
    begin_s += act.duration_s;
  }
  return meter;
}

std::string BuiltIn(const std::string& interface) {
  return *config::ReadDataFile(interface + "_mapping.json");
}

Result<nlohmann::ordered_json> Table(const Played& played, const Meter& meter) {
  const auto ranges = meter.Measure();
  if (!ranges) return ranges.error();
  return TableOf(played, *ranges,
                 {.participants = {"P01"}, .when = "now", .how = "live", .by = "t"},
                 BuiltIn(played.interface));
}

/// The synthetic users' slowest and fastest motion at tempo 1 (common/virtual/people/person.cc).
struct True {
  UserInterface interface;
  double slow_hz, fast_hz;
  double turn_deg;
  double low_share;  ///< Share in the acceleration of half a swing; a hop's is mostly its landing.
};
constexpr True kWrist{UserInterface::kWrist, 0.8, 3.8, 32, 0.75};
constexpr True kLeg{UserInterface::kLeg, 0.75, 3.0, 23, 0.8};

TEST(PersonalRanges, FollowTheTrueRangeOfUsersOfDifferentTempoAndAmplitude) {
  for (const True& is : {kWrist, kLeg}) {
    const Played played{stream::Name(is.interface)};
    double amplitude_before_mps2 = 0;
    for (const auto& [tempo, amplitude] : {std::pair{0.8, 0.8}, {1.0, 1.0}, {1.15, 1.25}}) {
      const auto table = Table(
          played, MeterOf(is.interface, StyleOf(tempo, amplitude), Motions(is.interface), played));
      ASSERT_TRUE(table) << played.interface << tempo << ": " << table.error().message;
      EXPECT_NEAR((*table)["walk_frequency_min_hz"], tempo * is.slow_hz, 0.08 * is.slow_hz);
      EXPECT_NEAR((*table)["run_frequency_max_hz"], tempo * is.fast_hz, 0.08 * is.fast_hz);
      const double turn_deg = amplitude * is.turn_deg;
      EXPECT_NEAR((*table)["turn_above_deg"], 0.625 * turn_deg, 0.08 * turn_deg);
      const double high_mps2 = (*table)["jump_amplitude_max_mps2"];
      EXPECT_GT(high_mps2, amplitude_before_mps2) << played.interface << tempo;
      EXPECT_LT((*table)["jump_amplitude_min_mps2"], is.low_share * high_mps2);
      amplitude_before_mps2 = high_mps2;
      const auto made = mapping::AnyInterface::Create({.interface = is.interface}, table->dump());
      EXPECT_TRUE(made) << made.error().message;
    }
  }
}

TEST(PersonalRanges, OfArmsAreThoseOfStraightAndOfBentOnes) {
  const Played played{"arm"};
  for (const double tempo : {0.9, 1.1}) {
    const auto table = Table(played, MeterOf(UserInterface::kArm, StyleOf(tempo, 1),
                                             Motions(UserInterface::kArm), played));
    ASSERT_TRUE(table) << table.error().message;
    EXPECT_NEAR((*table)["walk_frequency_min_hz"], tempo * 0.85, 0.1);
    EXPECT_NEAR((*table)["walk_frequency_max_hz"], tempo * 1.4, 0.15);
    EXPECT_NEAR((*table)["run_frequency_min_hz"], tempo * 1.2, 0.12);
    EXPECT_NEAR((*table)["run_frequency_max_hz"], tempo * 2.3, 0.2);
    EXPECT_TRUE(mapping::AnyInterface::Create({.interface = UserInterface::kArm}, table->dump()));
  }
}

TEST(PersonalRanges, OfArmsDoNotDependOnHowTheHandsHoldTheirControllers) {
  const Played played{"arm"};
  const auto turn_deg = [&played](double grip_deg) {
    users::Style style = StyleOf(1, 1);
    style.left_grip_rad = style.right_grip_rad = DegreesToRadians(grip_deg);
    const auto table =
        Table(played, MeterOf(UserInterface::kArm, style, Motions(UserInterface::kArm), played));
    return table ? (*table)["turn_above_deg"].get<double>() : 0;
  };
  const double straight_deg = turn_deg(0);
  EXPECT_GT(straight_deg, 10);
  for (const double grip_deg : {-40.0, 25.0}) {
    EXPECT_NEAR(turn_deg(grip_deg), straight_deg, 0.15 * straight_deg) << grip_deg;
  }
}

TEST(PersonalRanges, HaveTheBorderAtTheBuiltInTablesShareOfThePersonsRange) {
  const std::string built_in = BuiltIn("wrist");
  Ranges ranges{{quantity::kAlternateHz, {0.8, 3.8, 5}},
                {quantity::kTogetherHz, {1, 1.1, 5}},
                {quantity::kTogetherMps2, {5, 20, 5}},
                {quantity::kTurnRight, {-30, 32, 5}}};
  auto table = TableOf({"wrist"}, ranges, {}, built_in);
  ASSERT_TRUE(table);
  // Built in: 2 Hz of 0.5 to 4.5, three eighths of the way.
  EXPECT_NEAR((*table)["walk_run_border_hz"], 0.8 + 3.0 / 8 * 3.0, 0.001);
  EXPECT_EQ((*table)["jump_frequency_max_hz"], 3.0);  // One rhythm: as built in.
  ranges[quantity::kAlternateHz] = {0.6, 2.2, 5};
  table = TableOf({"wrist"}, ranges, {}, built_in);
  ASSERT_TRUE(table);
  for (const char* key : {"walk_run_border_hz", "walk_frequency_max_hz", "run_frequency_min_hz"}) {
    EXPECT_NEAR((*table)[key], 0.6 + 3.0 / 8 * 1.6, 0.001) << key;
  }
}

TEST(PersonalRanges, RefuseAMotionThatWasTooSmallTooShortOrNotVaried) {
  const Played played{"wrist"};
  const auto says = [&](std::vector<Act> acts, double amplitude) {
    const auto table =
        Table(played, MeterOf(UserInterface::kWrist, StyleOf(1, amplitude), acts, played));
    return table ? std::string("none") : table.error().message;
  };
  EXPECT_THAT(says(Motions(), 0.05), HasSubstr("the motion was too small or too short"));
  auto acts = Motions();
  acts[0].duration_s = acts[1].duration_s = 1;
  EXPECT_THAT(says(acts, 1), HasSubstr("left and right in turns"));
  acts = Motions();
  acts[1].wanted = {.gait = Gait::kWalk, .effort = 0.05};
  EXPECT_THAT(says(acts, 1), HasSubstr("move clearly slower first and clearly faster then"));
  acts = Motions();
  acts[2].wanted.size = 1;
  EXPECT_THAT(says(acts, 1), HasSubstr("jump low"));
  acts = Motions();
  acts[5].wanted.turn_rad = 0.1;  // To the left twice.
  EXPECT_THAT(says(acts, 1), HasSubstr("incline further"));
}

TEST(PersonalRanges, NameTheDeviceThatIsMissing) {
  Meter meter({"leg", "head"});
  stream::RigFeatures rig;
  rig.devices.resize(2);
  rig.devices[0].role = stream::DeviceRole::kLeftLeg;
  rig.devices[1].role = stream::DeviceRole::kRightLeg;
  for (auto& device : rig.devices) device.inclination_valid = true;
  for (int i = 0; i < 100; ++i) meter.Add(0.01 * i, rig, 0);
  const auto ranges = meter.Measure();
  ASSERT_FALSE(ranges);
  EXPECT_EQ(ranges.error().kind, ErrorKind::kNoDevice);
  EXPECT_THAT(ranges.error().message, HasSubstr("head is missing"));
  EXPECT_FALSE(Meter({"wrist"}).Measure());
  EXPECT_EQ(Meter({"joystick"}).Measure().error().kind, ErrorKind::kNoDevice);
}

TEST(PersonalRanges, OfAStickThatDoesNotReachItsEndMoveItsBorders) {
  for (const double full : {0.7, 1.0}) {
    Meter meter({"joystick"});
    double time_s = 0;
    const auto hold = [&](double x, double y) {
      for (int i = 0; i < 200; ++i) meter.AddStick(time_s += 0.01, x, y, false);
    };
    hold(0, full);
    hold(-full, 0);
    hold(full, 0);
    hold(0.02, 0.18);
    const auto table = Table({"joystick"}, meter);
    ASSERT_TRUE(table) << table.error().message;
    EXPECT_NEAR((*table)["run_radius"], 0.6 * full, 0.001);
    EXPECT_NEAR((*table)["run_radius_max"], 0.95 * full, 0.001);
    EXPECT_NEAR((*table)["centre_radius"], std::hypot(0.02, 0.18) + 0.1, 0.001);
    EXPECT_TRUE(
        mapping::AnyInterface::Create({.interface = UserInterface::kJoystick}, table->dump()));
  }
}

Measured PersonWith(const std::string& code, double slow_hz, double fast_hz) {
  Measured one{{"wrist"}, {}, {}};
  one.provenance.participants = {code};
  one.ranges = {{quantity::kAlternateHz, {slow_hz, fast_hz, 5}},
                {quantity::kTogetherHz, {1, 2, 5}},
                {quantity::kTogetherMps2, {5, 20, 5}},
                {quantity::kTurnRight, {-30, 32, 5}}};
  return one;
}

TEST(GroupRanges, AreTheMediansOfTheirPeople) {
  const auto group =
      Merge({PersonWith("P01", 0.5, 3), PersonWith("P02", 0.9, 4), PersonWith("P03", 0.6, 9)});
  ASSERT_TRUE(group);
  EXPECT_EQ(group->ranges.at(quantity::kAlternateHz).low, 0.6);
  EXPECT_EQ(group->ranges.at(quantity::kAlternateHz).high, 4);
  EXPECT_EQ(group->provenance.participants, (std::vector<std::string>{"P01", "P02", "P03"}));
  const auto two = Merge({PersonWith("P01", 0.5, 3), PersonWith("P02", 0.9, 4)});
  EXPECT_DOUBLE_EQ(two->ranges.at(quantity::kAlternateHz).high, 3.5);
}

TEST(GroupRanges, RefuseOneTableTwiceAndTwoInterfaces) {
  EXPECT_THAT(Merge({PersonWith("P01", 1, 2), PersonWith("P01", 1, 3)}).error().message,
              HasSubstr("P01 comes twice"));
  Measured arm = PersonWith("P02", 1, 2);
  arm.played.interface = "arm";
  EXPECT_THAT(Merge({PersonWith("P01", 1, 2), arm}).error().message, HasSubstr("wrist and arm"));
}

TEST(MeasuredTable, SaysWhomHowAndWhenAndReadsBack) {
  const Measured one = PersonWith("P01", 0.7, 3.5);
  const auto table = TableOf({"wrist"}, one.ranges,
                             {.participants = {"P01"},
                              .when = "2026-11-23T01:02:03Z",
                              .how = "live",
                              .by = "footing-study 1",
                              .simulated = true},
                             BuiltIn("wrist"));
  ASSERT_TRUE(table);
  const auto again = MeasuredOf(table->dump(), "a.json");
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_EQ(again->provenance.participants, std::vector<std::string>{"P01"});
  EXPECT_EQ(again->provenance.when, "2026-11-23T01:02:03Z");
  EXPECT_TRUE(again->provenance.simulated);
  EXPECT_EQ(again->ranges.at(quantity::kAlternateHz).high, 3.5);
  EXPECT_THAT(MeasuredOf(BuiltIn("wrist"), "a.json").error().message,
              HasSubstr("a.json has no measured ranges"));
  EXPECT_FALSE(MeasuredOf(R"({"measured": {"interface": 3}})", "a.json"));
}

}  // namespace
}  // namespace footing::study::ranges
