#include "daemon/simulation/mapping/any_interface.h"

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

TEST(AnyInterface, UsesTheRolesOfItsLimbs) {
  using stream::DeviceRole;
  EXPECT_TRUE(Uses({.interface = UserInterface::kArm}, DeviceRole::kLeftHand));
  EXPECT_TRUE(Uses({.interface = UserInterface::kLeg}, DeviceRole::kRightLeg));
  EXPECT_TRUE(Uses({.interface = UserInterface::kBoards}, DeviceRole::kLeftBoard));
  EXPECT_FALSE(Uses({.interface = UserInterface::kLeg}, DeviceRole::kLeftHand));
  EXPECT_FALSE(Uses({.interface = UserInterface::kWrist}, DeviceRole::kEditor));
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

}  // namespace
}  // namespace footing::mapping
