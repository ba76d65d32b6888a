#include "daemon/simulation/mapping/wrist.h"

#include <limits>
#include <numbers>

#include "tests/simulation/test_world.h"

namespace footing::mapping {
namespace {

using stream::Gait;
constexpr double kPi = std::numbers::pi;

WristMapping Mapping() {
  return ParseWristMapping(test::DataFile("wrist_mapping.json"), "wrist_mapping.json").value();
}

WristFeatures Swing(double frequency_hz, double phase_rad, double amplitude_mps2 = 10,
                    double roll_rad = 0) {
  const HandFeatures hand{.present = true,
                          .moving = true,
                          .frequency_valid = true,
                          .frequency_hz = frequency_hz,
                          .amplitude_valid = true,
                          .amplitude_mps2 = amplitude_mps2,
                          .inclination_valid = true,
                          .roll_rad = roll_rad};
  return {.left = hand, .right = hand, .phase_valid = true, .phase_rad = phase_rad};
}

TEST(Wrist, GaitFollowsPhaseAndFrequency) {
  struct {
    double frequency_hz, phase_rad;
    Gait gait;
    double speed_mps;
  } const rows[] = {{0.5, kPi, Gait::kWalk, 0.2},   // Ends and middles of the committed ranges.
                    {1.25, kPi, Gait::kWalk, 0.8},  // 0.2 + (1.25 - 0.5) / 1.5 * 1.2
                    {1.9, -3.0, Gait::kWalk, 1.32}, {2.1, kPi, Gait::kRun, 1.62},
                    {3.25, 2.5, Gait::kRun, 3.0},   {9.0, kPi, Gait::kRun, 4.5},
                    {1.75, 0.2, Gait::kJump, 0.5},  {1.75, -0.9, Gait::kJump, 0.5}};
  for (const auto& row : rows) {
    WristInterface wrist(Mapping());
    const auto command = wrist.Advance(0, Swing(row.frequency_hz, row.phase_rad));
    EXPECT_EQ(command.gait, row.gait) << row.frequency_hz << " Hz, phase " << row.phase_rad;
    EXPECT_NEAR(command.speed_mps, row.speed_mps, 1e-9) << row.frequency_hz;
  }
}

TEST(Wrist, AmplitudeSetsTheHeightOfAJump) {
  WristInterface wrist(Mapping());
  EXPECT_NEAR(wrist.Advance(0, Swing(2, 0, 4)).height_m, 0.08, 1e-9);
  EXPECT_NEAR(wrist.Advance(0, Swing(2, 0, 14.5)).height_m, 0.215, 1e-9);  // Middle of both.
  EXPECT_NEAR(wrist.Advance(0, Swing(2, 0, 60)).height_m, 0.35, 1e-9);
}

TEST(Wrist, RestingHandsStepInPlace) {
  WristInterface wrist(Mapping());
  wrist.Advance(0, Swing(1, kPi));
  WristFeatures rest = Swing(1, kPi);
  rest.left.moving = rest.right.moving = false;
  EXPECT_EQ(wrist.Advance(0.1, rest).gait, Gait::kStep);
  wrist.Advance(0.2, Swing(1, kPi));
  WristFeatures one = Swing(1, kPi);
  one.left.present = false;
  EXPECT_EQ(wrist.Advance(0.3, one).gait, Gait::kStep);
}

TEST(Wrist, BordersHaveHysteresis) {
  WristInterface wrist(Mapping());
  EXPECT_EQ(wrist.Advance(0, Swing(1.95, kPi)).gait, Gait::kWalk);
  EXPECT_EQ(wrist.Advance(1, Swing(2.05, kPi)).gait, Gait::kWalk);
  EXPECT_EQ(wrist.Advance(2, Swing(2.10, kPi)).gait, Gait::kRun);
  EXPECT_EQ(wrist.Advance(3, Swing(1.95, kPi)).gait, Gait::kRun);
  EXPECT_EQ(wrist.Advance(4, Swing(1.90, kPi)).gait, Gait::kWalk);
  EXPECT_EQ(wrist.Advance(5, Swing(1.5, kPi / 2)).gait, Gait::kWalk);
  EXPECT_EQ(wrist.Advance(6, Swing(1.5, 1.2)).gait, Gait::kJump);
  EXPECT_EQ(wrist.Advance(7, Swing(1.5, -kPi / 2)).gait, Gait::kJump);
  EXPECT_EQ(wrist.Advance(8, Swing(1.5, -1.9)).gait, Gait::kWalk);
}

TEST(Wrist, LeaningTurnsTowardsTheLowerSide) {
  WristInterface wrist(Mapping());
  const double step_rad = 5 * kPi / 180;  // Paper: constant increment of 5 degrees.
  EXPECT_EQ(wrist.Advance(0, Swing(1, kPi, 10, 0.3)).turn_per_step_rad, 0);
  // Left side higher: lean to the right, turn to the right, which is negative.
  EXPECT_NEAR(wrist.Advance(1, Swing(1, kPi, 10, 0.5)).turn_per_step_rad, -step_rad, 1e-12);
  EXPECT_NEAR(wrist.Advance(2, Swing(1, kPi, 10, 0.3)).turn_per_step_rad, -step_rad, 1e-12);
  EXPECT_EQ(wrist.Advance(3, Swing(1, kPi, 10, 0.2)).turn_per_step_rad, 0);
  EXPECT_NEAR(wrist.Advance(4, Swing(1, kPi, 10, -0.5)).turn_per_step_rad, step_rad, 1e-12);
}

TEST(Wrist, FeaturesNotYetValidHoldTheGaitForAWhile) {
  WristInterface wrist(Mapping());
  wrist.Advance(0, Swing(3, kPi));
  WristFeatures unsure = Swing(3, kPi);
  unsure.phase_valid = false;
  EXPECT_EQ(wrist.Advance(1, unsure).gait, Gait::kRun);
  EXPECT_EQ(wrist.Advance(2.9, unsure).gait, Gait::kRun);
  EXPECT_EQ(wrist.Advance(3.1, unsure).gait, Gait::kStep);  // hold_s is 3.
  WristInterface fresh(Mapping());
  EXPECT_EQ(fresh.Advance(0, unsure).gait, Gait::kStep);
}

TEST(WristFeatures, AreTakenFromTheHandsAndTheirPair) {
  stream::RigFeatures rig;
  rig.devices.resize(3);
  rig.devices[0].device = 7;
  rig.devices[0].role = stream::DeviceRole::kRightHand;
  rig.devices[0].frequency_valid = true;
  rig.devices[0].frequency_hz = std::numeric_limits<double>::quiet_NaN();
  rig.devices[1].device = 9;
  rig.devices[1].role = stream::DeviceRole::kHead;
  rig.devices[2].device = 4;
  rig.devices[2].role = stream::DeviceRole::kLeftHand;
  rig.devices[2].moving = true;
  rig.pairs = {{9, 7, true, 2.0}, {7, 4, true, 0.5}};
  const WristFeatures features = ToWristFeatures(rig);
  EXPECT_TRUE(features.left.present && features.left.moving);
  EXPECT_FALSE(features.right.frequency_valid);
  EXPECT_TRUE(features.phase_valid);
  EXPECT_EQ(features.phase_rad, -0.5);  // That pair was given the other way round.
}

TEST(WristMapping, RefusesRangesThatDoNotRise) {
  std::string text = test::DataFile("wrist_mapping.json");
  const std::string key = "\"walk_frequency_max_hz\": 2.0";
  text.replace(text.find(key), key.size(), "\"walk_frequency_max_hz\": 0.4");
  EXPECT_FALSE(ParseWristMapping(text, "wrist_mapping.json").ok());
}

}  // namespace
}  // namespace footing::mapping
