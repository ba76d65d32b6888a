#include <cmath>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "clients/stream/plan.h"
#include "common/base/units.h"

namespace footing::stream_client {
namespace {

/// Purpose of a grip: "+slope", "-curve", ...; empty for level ground and while it changes over.
std::string KindOf(const BuilderGrip& grip) {
  const double up = grip.pitch_rad, right = grip.roll_rad;
  const auto sign = [](double value) { return value > 0 ? "+" : "-"; };
  if (grip.b) return "pit";
  if (std::fabs(up) > 0.25 && std::fabs(right) < 1e-9)
    return sign(up) + std::string(grip.a ? "step" : "slope");
  if (std::fabs(right) > 0.25 && std::fabs(up) < 1e-9) return sign(right) + std::string("curve");
  return "";
}

std::set<std::string> KindsWithin(const BuilderScript& script, double seconds) {
  std::set<std::string> kinds;
  for (double t_s = 0; t_s < seconds; t_s += 0.05) kinds.insert(KindOf(script.At(t_s)));
  kinds.erase("");
  return kinds;
}

TEST(BuilderScript, HasSlopesCurvesAndStepsToBothSidesBeforeAnyComesAgain) {
  const std::set<std::string> all{"+slope", "-slope", "+curve", "-curve", "+step", "-step"};
  std::set<std::string> with_pits = all;
  with_pits.insert("pit");
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    // Seven kinds of at most 1.8 s; with pits eight.
    EXPECT_EQ(KindsWithin(BuilderScript(seed, false), 7 * 1.8), all) << seed;
    EXPECT_EQ(KindsWithin(BuilderScript(seed, true), 8 * 1.8), with_pits) << seed;
  }
}

TEST(BuilderScript, InclinesByUpTo45DegreesWithoutAJump) {
  const BuilderScript script(3, true);
  BuilderGrip last = script.At(0);
  for (double t_s = 0; t_s < 2 * script.duration_s(); t_s += 0.01) {
    const BuilderGrip now = script.At(t_s);
    EXPECT_LE(std::hypot(now.roll_rad, now.pitch_rad), DegreesToRadians(45) + 1e-9);
    // From one side to the other within a quarter of a second: 3.6 degrees in 10 ms.
    EXPECT_LT(std::fabs(now.roll_rad - last.roll_rad), DegreesToRadians(4)) << t_s;
    EXPECT_LT(std::fabs(now.pitch_rad - last.pitch_rad), DegreesToRadians(4)) << t_s;
    last = now;
  }
}

TEST(BuilderScript, RepeatsWithItsSeedAndDiffersWithAnother) {
  const BuilderScript one(5, false), same(5, false), other(6, false);
  double difference = 0;
  for (double t_s = 0; t_s < 30; t_s += 0.1) {
    EXPECT_EQ(one.At(t_s).roll_rad, same.At(t_s).roll_rad);
    difference += std::fabs(one.At(t_s).roll_rad - other.At(t_s).roll_rad);
  }
  EXPECT_GT(difference, 1);
}

TEST(PlanBuilder, IsOneDeviceInTheRoleEditor) {
  const auto plan = PlanBuilder(false, {});
  ASSERT_TRUE(plan);
  ASSERT_EQ(plan->devices.size(), 1u);
  EXPECT_EQ(plan->devices[0].role(), stream::DeviceRole::kEditor);
  Common unknown;
  unknown.link = "perfect";
  EXPECT_FALSE(PlanBuilder(false, unknown));
}

using testing::HasSubstr;

TEST(Plan, AUserSwingsALeftAndARightWiimoteOfTheirOwnSerials) {
  const auto plan = PlanUser("demo", "wrist", {});
  ASSERT_TRUE(plan);
  ASSERT_EQ(plan->devices.size(), 2u);
  EXPECT_EQ(plan->devices[0].role(), stream::DeviceRole::kLeftHand);
  EXPECT_EQ(plan->devices[1].role(), stream::DeviceRole::kRightHand);
  EXPECT_NE(plan->devices[0].identity().serial, plan->devices[1].identity().serial);
}

TEST(Plan, AnInterfaceNotBuiltIsAUsageErrorThatListsWhatIs) {
  const auto plan = PlanUser("demo", "leg", {});
  ASSERT_FALSE(plan);
  EXPECT_EQ(plan.error().kind, ErrorKind::kUsage);
  EXPECT_THAT(plan.error().message, HasSubstr("there are: wrist, joystick"));
}

TEST(Plan, AnUnknownLinkIsRefused) {
  Common common;
  common.link = "perfect";
  const auto plan = PlanUser("demo", "wrist", common);
  ASSERT_FALSE(plan);
  EXPECT_THAT(plan.error().message, HasSubstr("ideal, good and poor"));
}

TEST(Plan, AMissingRecordingIsNamed) {
  const auto plan = PlanAccelerations("/nonexistent/left.csv", "", 100, {});
  ASSERT_FALSE(plan);
  EXPECT_THAT(plan.error().message, HasSubstr("/nonexistent/left.csv"));
}

TEST(Plan, TheSameSeedMakesTheSameSerials) {
  const auto one = PlanUser("demo", "wrist", {});
  const auto two = PlanUser("demo", "wrist", {});
  ASSERT_TRUE(one && two);
  EXPECT_EQ(one->devices[0].identity().serial, two->devices[0].identity().serial);
}

wrists::Segment Swing(double duration_s, double frequency_hz, double phase_rad,
                      double roll_rad = 0) {
  wrists::Segment segment;
  segment.duration_s = duration_s;
  segment.frequency_hz = frequency_hz;
  segment.phase_rad = phase_rad;
  segment.amplitude_mps2 = frequency_hz > 0 ? 7 : 0;
  segment.roll_rad = roll_rad;
  return segment;
}

double Radius(const StickState& state) { return std::hypot(state.x, state.y); }

TEST(StickMotion, WalksInsideTheBorderOfThePaperAndRunsOutside) {
  const StickMotion stick({Swing(2, 0, 0), Swing(2, 1.3, kPi), Swing(2, 3, kPi)}, 0.2);
  EXPECT_EQ(Radius(stick.At(1)), 0);
  EXPECT_GT(Radius(stick.At(3)), 0.2);
  EXPECT_LT(Radius(stick.At(3)), 0.6);
  EXPECT_GT(Radius(stick.At(5)), 0.6);
  EXPECT_LE(Radius(stick.At(5)), 1);
  EXPECT_EQ(stick.At(5).x, 0);
  EXPECT_EQ(stick.DurationSeconds(), 6);
}

TEST(StickMotion, MovesWithoutAJump) {
  const StickMotion stick({Swing(2, 0, 0), Swing(2, 3, kPi, 0.3), Swing(2, 1.3, kPi, -0.3)}, 0.2);
  StickState last = stick.At(0);
  for (double t_s = 0; t_s < 6; t_s += 0.01) {
    const StickState now = stick.At(t_s);
    EXPECT_LT(std::hypot(now.x - last.x, now.y - last.y), 0.09) << t_s;
    last = now;
  }
}

TEST(StickMotion, TurnsToTheSideOfTheInclination) {
  const double roll_rad = 20 * kPi / 180;
  const StickMotion stick({Swing(2, 1.3, kPi, roll_rad), Swing(2, 1.3, kPi, -roll_rad)}, 0.2);
  EXPECT_GT(stick.At(1).x, 0.3);
  EXPECT_GT(stick.At(1).y, 0.1);
  EXPECT_LT(stick.At(3).x, -0.3);
}

TEST(StickMotion, PressesTheButtonOnceACycleOfHandsInPhase) {
  const StickMotion stick({Swing(3, 2, 0)}, 0.2);
  int presses = 0;
  bool last = false;
  for (int i = 0; i < 300; ++i) {
    const bool jump = stick.At(i * 0.01).jump;
    if (jump && !last) ++presses;
    last = jump;
  }
  EXPECT_EQ(presses, 6);
  EXPECT_FALSE(StickMotion({Swing(3, 2, kPi)}, 0.2).At(0).jump);
}

using testing::ElementsAre;

TEST(Table, AHeaderAndEmptyLinesAreNoRows) {
  const auto table = ParseTable("ax,ay,az\r\n1,2,3\r\n\n-4.5, 5e-1 ,6\n", 3, "f");
  ASSERT_TRUE(table);
  EXPECT_THAT(table->rows, ElementsAre(ElementsAre(1, 2, 3), ElementsAre(-4.5, 0.5, 6)));
}

TEST(Table, TheFaultyLineIsNamed) {
  for (const char* text : {"1,2,3\n1,2\n", "1,2,3\n1,2,3,4\n", "1,2,3\n1,x,3\n", "1,2,3\n1,nan,3\n",
                           "1,2,3\n1,inf,3\n", "1,2,3\n1,,3\n"}) {
    const auto table = ParseTable(text, 3, "some.csv");
    ASSERT_FALSE(table) << text;
    EXPECT_EQ(table.error().kind, ErrorKind::kInvalidData);
    EXPECT_THAT(table.error().message, HasSubstr("some.csv, line 2")) << text;
  }
}

TEST(Table, WithoutRowsIsInvalid) {
  EXPECT_FALSE(ParseTable("", 3, "f"));
  EXPECT_FALSE(ParseTable("ax,ay,az\n", 3, "f"));
}

}  // namespace
}  // namespace footing::stream_client
