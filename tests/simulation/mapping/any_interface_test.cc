#include "daemon/simulation/mapping/any_interface.h"
#include "common/base/units.h"
#include "tests/simulation/mapping/settled.h"
#include "tests/simulation/test_world.h"

namespace footing::mapping {
namespace {

using stream::UserInterface;

TEST(AnyInterface, EachHasItsCommittedTableAndRestsWithoutInputs) {
  for (const UserInterface interface : stream::kUserInterfaces) {
    const std::string table = test::DataFile(MappingFileOf(interface));
    auto made = AnyInterface::Create({.interface = interface}, table);
    ASSERT_TRUE(made.ok()) << made.error().message;
    EXPECT_EQ(made->Rest(1), biped::GaitCommand{}) << stream::Name(interface);
    EXPECT_EQ(made->state().interface, interface);
    EXPECT_EQ(made->state().activity, stream::Activity::kAbsent);
    EXPECT_NE(made->state().missing_roles, 0u);
  }
}

TEST(AnyInterface, ATablesErrorNamesTheFileAndTheKey) {
  for (const UserInterface interface : stream::kUserInterfaces) {
    std::string table = test::DataFile(MappingFileOf(interface));
    const std::string key = "\"turn_per_step_deg\": 5.0";
    table.replace(table.find(key), key.size(), "\"turn_per_step_deg\": 50.0");
    const auto made = AnyInterface::Create({.interface = interface}, table);
    ASSERT_FALSE(made.ok()) << stream::Name(interface);
    EXPECT_NE(made.error().message.find(MappingFileOf(interface)), std::string::npos);
    EXPECT_NE(made.error().message.find("turn_per_step_deg"), std::string::npos);
  }
}

TEST(AnyInterface, ATableOfAnotherInterfaceIsRefused) {
  const std::string table = test::DataFile(MappingFileOf(UserInterface::kJoystick));
  EXPECT_FALSE(AnyInterface::Create({.interface = UserInterface::kWrist}, table).ok());
}

TEST(AnyInterface, SaysWhichRolesItLacks) {
  using stream::DeviceRole;
  using stream::RoleBit;
  const std::uint32_t hands = RoleBit(DeviceRole::kLeftHand) | RoleBit(DeviceRole::kRightHand);
  const std::uint32_t legs = RoleBit(DeviceRole::kLeftLeg) | RoleBit(DeviceRole::kRightLeg);
  const std::uint32_t head = RoleBit(DeviceRole::kHead), trunk = RoleBit(DeviceRole::kTrunk);
  EXPECT_EQ(MissingRoles({.interface = UserInterface::kWrist}, hands), 0u);
  EXPECT_EQ(MissingRoles({.interface = UserInterface::kArm}, RoleBit(DeviceRole::kLeftHand)),
            RoleBit(DeviceRole::kRightHand));
  EXPECT_EQ(MissingRoles({.interface = UserInterface::kJoystick}, RoleBit(DeviceRole::kLeftHand)),
            0u);
  EXPECT_EQ(MissingRoles({.interface = UserInterface::kJoystick}, legs), hands);
  EXPECT_EQ(MissingRoles({.interface = UserInterface::kBoards}, hands | legs),
            RoleBit(DeviceRole::kLeftBoard) | RoleBit(DeviceRole::kRightBoard));
  InterfaceOptions leg{.interface = UserInterface::kLeg};
  EXPECT_EQ(MissingRoles(leg, legs | trunk), head);
  leg.leg.turn_by = stream::TurnSource::kTrunk;
  EXPECT_EQ(MissingRoles(leg, legs | trunk), 0u);
  leg.leg.turn_by = stream::TurnSource::kFeet;
  EXPECT_EQ(MissingRoles(leg, legs), 0u);
}

/// Braked before it leaps, the character's leap would be no longer than a stride.
TEST(AnyInterface, AJumpOutOfARunKeepsTheRunUpUntilTheCharacterJumps) {
  auto stick = *AnyInterface::Create({.interface = UserInterface::kJoystick},
                                     test::DataFile(MappingFileOf(UserInterface::kJoystick)));
  Inputs inputs;
  inputs.stick = {.present = true, .y = 0.7};
  const biped::GaitCommand run = stick.Advance(0, inputs);
  ASSERT_EQ(run.gait, stream::Gait::kRun);
  ASSERT_GT(run.speed_mps, 2);
  inputs.stick.presses = 1;
  inputs.running = stream::Gait::kRun;
  const biped::GaitCommand jump = stick.Advance(0.1, inputs);
  EXPECT_EQ(jump.gait, stream::Gait::kJump);
  EXPECT_NEAR(jump.speed_mps, 2, 1e-9);  // The fastest stable jump.
  inputs.running = stream::Gait::kJump;
  EXPECT_NEAR(stick.Advance(0.2, inputs).speed_mps, 1.5, 1e-9);  // The table's again.
}

TEST(AnyInterface, AJumpOutOfAWalkHasTheTablesSpeed) {
  auto stick = *AnyInterface::Create({.interface = UserInterface::kJoystick},
                                     test::DataFile(MappingFileOf(UserInterface::kJoystick)));
  Inputs inputs;
  inputs.stick = {.present = true, .y = 0.4};
  const double walk_mps = stick.Advance(0, inputs).speed_mps;
  inputs.stick.presses = 1;
  inputs.running = stream::Gait::kWalk;
  EXPECT_NEAR(stick.Advance(0.1, inputs).speed_mps, walk_mps, 1e-9);
}

using stream::DeviceRole;
using stream::Gait;
using stream::TurnSource;

constexpr double kHeadStepRad = DegreesToRadians(5);

LegInterface NewLeg(const LegOptions& options = {}) {
  return LegInterface(ParseLegMapping(test::DataFile(kLegMappingFile), kLegMappingFile).value(),
                      options);
}

LimbFeatures Leg(double frequency_hz, double amplitude_mps2) {
  return {.present = true,
          .moving = true,
          .frequency_valid = true,
          .frequency_hz = frequency_hz,
          .amplitude_valid = true,
          .amplitude_mps2 = amplitude_mps2,
          .inclination_valid = true,
          .mounted = true};
}

LimbFeatures Upright(double roll_deg) {
  return {.present = true, .inclination_valid = true, .roll_rad = DegreesToRadians(roll_deg)};
}

Inputs Stepping(double frequency_hz, double phase_rad, double left_mps2 = 15,
                double right_mps2 = 15) {
  Inputs inputs;
  inputs.legs = {.left = Leg(frequency_hz, left_mps2),
                 .right = Leg(frequency_hz, right_mps2),
                 .phase_valid = true,
                 .phase_rad = phase_rad};
  inputs.head = Upright(0);
  return inputs;
}

Inputs Standing() {
  Inputs inputs = Stepping(1, kPi);
  inputs.legs.left.moving = inputs.legs.right.moving = false;
  inputs.legs.phase_valid = false;
  return inputs;
}

TEST(Leg, SlowStepsWalkFastOnesRunBothLegsTogetherJumpAndStandingStepsInPlace) {
  LegInterface leg = NewLeg();
  EXPECT_EQ(Settled(leg, 0, Standing()).gait, Gait::kStep);
  const auto walk = Settled(leg, 2, Stepping(1.25, kPi));
  EXPECT_EQ(walk.gait, Gait::kWalk);
  EXPECT_NEAR(walk.speed_mps, 0.8, 1e-9);  // Half way from 0.5 to 2 Hz, from 0.2 to 1.4 m/s.
  EXPECT_NEAR(walk.cadence_hz, 2.5, 1e-9);
  EXPECT_EQ(Settled(leg, 4, Stepping(1.95, kPi)).gait, Gait::kWalk);
  EXPECT_EQ(Settled(leg, 6, Stepping(2.1, -3)).gait, Gait::kRun);
  const auto run = Settled(leg, 8, Stepping(2.75, kPi));
  EXPECT_NEAR(run.speed_mps, 3, 1e-9);  // Half way from 2 to 3.5 Hz, from 1.5 to 4.5 m/s.
  const auto jump = Settled(leg, 10, Stepping(1.5, 0.2));
  EXPECT_EQ(jump.gait, Gait::kJump);
  EXPECT_EQ(Settled(leg, 12, Standing()).gait, Gait::kStep);
}

TEST(Leg, TheHeadTurnsAlsoWhileStandingAndWithoutItTheWayIsStraight) {
  LegInterface leg = NewLeg();
  for (const bool steps : {false, true}) {
    Inputs inputs = steps ? Stepping(1, kPi) : Standing();
    inputs.head = Upright(20);  // Left side higher: inclined to the right.
    EXPECT_NEAR(leg.Advance(0, inputs).turn_per_step_rad, -kHeadStepRad, 1e-12);
    inputs.head = Upright(-20);
    EXPECT_NEAR(leg.Advance(1, inputs).turn_per_step_rad, kHeadStepRad, 1e-12);
    inputs.head = {};
    leg.Advance(1.1, inputs);
    EXPECT_EQ(leg.Advance(1.1 + Turn::kHoldS + 0.01, inputs).turn_per_step_rad, 0);
    EXPECT_EQ(leg.state().missing_roles, stream::RoleBit(DeviceRole::kHead));
  }
}

TEST(Leg, TheTrunkTurnsWhereItIsChosenAndTheHeadDoesNot) {
  LegInterface leg = NewLeg({.turn_by = TurnSource::kTrunk});
  Inputs inputs = Stepping(1, kPi);
  inputs.head = Upright(40);
  inputs.trunk = Upright(0);
  inputs.trunk.mounted = true;
  EXPECT_EQ(leg.Advance(0, inputs).turn_per_step_rad, 0);
  inputs.trunk.roll_rad = DegreesToRadians(-18);
  EXPECT_NEAR(leg.Advance(1, inputs).turn_per_step_rad, kHeadStepRad, 1e-12);
  EXPECT_EQ(leg.state().turn.source, TurnSource::kTrunk);
}

TEST(Leg, TheFootThatIsLiftedHigherIsTheOuterOne) {
  LegInterface leg = NewLeg({.turn_by = TurnSource::kFeet});
  EXPECT_EQ(leg.Advance(0, Stepping(1, kPi, 15, 13)).turn_per_step_rad, 0);
  // (20 - 12) / 32 = 0.25, above 0.2: the left foot is the outer one of a turn to the right.
  EXPECT_NEAR(leg.Advance(1, Stepping(1, kPi, 20, 12)).turn_per_step_rad, -kHeadStepRad, 1e-12);
  EXPECT_NEAR(leg.Advance(2, Stepping(1, kPi, 18, 13)).turn_per_step_rad, -kHeadStepRad, 1e-12);
  EXPECT_EQ(leg.Advance(3, Stepping(1, kPi, 15, 14)).turn_per_step_rad, 0);
  EXPECT_NEAR(leg.Advance(4, Stepping(1, kPi, 12, 20)).turn_per_step_rad, kHeadStepRad, 1e-12);
  EXPECT_EQ(leg.Advance(5, Standing()).turn_per_step_rad, 0);
}

TEST(Leg, FeetThatAreLiftedUnequallyStepWhateverTheirPhase) {
  const double left_mps2 = 20, right_mps2 = 12;
  Inputs alike = Stepping(2.6, 0.1, left_mps2, right_mps2);
  Inputs unclear = alike;
  unclear.legs.phase_valid = false;
  Inputs low = unclear;  // The foot that is hardly lifted shows another rhythm, or none.
  low.legs.right.frequency_hz = 5.2;
  for (const Inputs& inputs : {alike, unclear, low}) {
    LegInterface leg = NewLeg({.turn_by = TurnSource::kFeet});
    const auto command = Settled(leg, 0, inputs);
    EXPECT_EQ(command.gait, Gait::kRun);
    EXPECT_NEAR(command.speed_mps, 2.7, 1e-9);  // 0.4 of the way from 1.5 to 4.5 m/s.
  }
  LegInterface by_head = NewLeg();
  EXPECT_EQ(Settled(by_head, 0, alike).gait, Gait::kJump);
}

TEST(Leg, FeetThatTurnedJumpOnceTheyAreSeenTogetherOrLiftedAlike) {
  const Inputs uneven = Stepping(2.6, kPi, 20, 12);
  const Inputs alike = Stepping(2.6, 0, 17, 16);
  Inputs together = Stepping(2.6, 0, 20, 12);  // From the last period; no new one yet.
  together.legs.left.frequency_valid = together.legs.right.frequency_valid = false;
  for (const Inputs& inputs : {alike, together}) {
    LegInterface leg = NewLeg({.turn_by = TurnSource::kFeet});
    EXPECT_EQ(Settled(leg, 0, uneven).gait, Gait::kRun);
    EXPECT_EQ(Settled(leg, 2, inputs).gait, Gait::kJump);
  }
}

TEST(Leg, ThePictureFollowsTheHeadOnlyWhereThatIsChosen) {
  Inputs inputs = Standing();
  inputs.head = Upright(12);
  LegInterface still = NewLeg(), rolling = NewLeg({.camera_roll = true});
  still.Advance(0, inputs);
  rolling.Advance(0, inputs);
  EXPECT_EQ(still.state().view_roll_rad, 0);
  EXPECT_NEAR(rolling.state().view_roll_rad, DegreesToRadians(12), 1e-12);
  inputs.head = Upright(80);
  rolling.Advance(1, inputs);
  EXPECT_NEAR(rolling.state().view_roll_rad, DegreesToRadians(45), 1e-12);
}

TEST(Leg, ATableMayChooseThatThePictureFollowsTheHead) {
  std::string table = test::DataFile(kLegMappingFile);
  table.insert(table.find('{') + 1, "\"camera_roll\": true,");
  const auto mapping = ParseLegMapping(table, kLegMappingFile);
  ASSERT_TRUE(mapping) << mapping.error().message;
  LegInterface leg(*mapping, {});
  Inputs inputs = Standing();
  inputs.head = Upright(12);
  leg.Advance(0, inputs);
  EXPECT_NEAR(leg.state().view_roll_rad, DegreesToRadians(12), 1e-12);
  table.replace(table.find("true"), 4, "7");
  const auto wrong = ParseLegMapping(table, kLegMappingFile);
  ASSERT_FALSE(wrong);
  EXPECT_NE(wrong.error().message.find("camera_roll is 7, allowed is true or false"),
            std::string::npos);
}

TEST(Leg, WithoutItsLegsTheCharacterStopsAndTurnsNoMore) {
  LegInterface leg = NewLeg();
  Inputs inputs = Stepping(1, kPi);
  inputs.head = Upright(30);
  Settled(leg, 0, inputs);
  inputs.legs = {};
  const auto command = leg.Advance(2, inputs);
  EXPECT_EQ(command.gait, Gait::kStep);
  EXPECT_EQ(command.turn_per_step_rad, 0);
}

TEST(Leg, ShinsWithoutAMountingAreNamed) {
  LegInterface leg = NewLeg();
  Inputs inputs = Stepping(1, kPi);
  inputs.legs.right.mounted = false;
  leg.Advance(0, inputs);
  EXPECT_EQ(leg.state().unmounted_roles, stream::RoleBit(DeviceRole::kRightLeg));
}

}  // namespace
}  // namespace footing::mapping
