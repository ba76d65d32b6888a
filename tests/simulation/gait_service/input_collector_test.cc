#include "daemon/simulation/gait_service/input_collector.h"

#include <gtest/gtest.h>

#include <limits>

namespace footing::gait_service {
namespace {

using stream::UserInterface;

constexpr std::int64_t kMs = 1'000'000;

void AddDevice(v1::Tick& tick, std::uint32_t number, const std::string& rig, v1::DeviceRole role,
               bool mounted = false) {
  v1::DeviceStatus& device = *tick.mutable_status()->add_devices();
  device.set_device(number);
  device.set_rig(rig);
  device.set_role(role);
  device.set_mounted(mounted);
}

void AddStick(v1::Tick& tick, std::uint32_t device, double x, double y) {
  v1::NunchukSample& sample = *tick.mutable_nunchuk()->add_samples();
  sample.set_device(device);
  sample.set_stick_x(x);
  sample.set_stick_y(y);
  sample.set_simulated(true);
}

void AddButtons(v1::Tick& tick, std::uint32_t device, std::uint32_t buttons) {
  v1::MotionSample& sample = *tick.mutable_motion()->add_samples();
  sample.set_device(device);
  sample.set_buttons(buttons);
}

void AddBoard(v1::Tick& tick, std::uint32_t device, double corner_n, double cop_y_m) {
  v1::BoardSample& sample = *tick.mutable_boards()->add_samples();
  sample.set_device(device);
  sample.set_top_left_n(corner_n);
  sample.set_top_right_n(corner_n);
  sample.set_bottom_left_n(corner_n);
  sample.set_bottom_right_n(corner_n);
  sample.set_cop_valid(true);
  sample.set_cop_y_m(cop_y_m);
}

v1::Tick StickTick() {
  v1::Tick tick;
  AddDevice(tick, 3, "main", v1::DEVICE_ROLE_RIGHT_HAND);
  AddDevice(tick, 4, "main", v1::DEVICE_ROLE_LEFT_LEG);
  return tick;
}

TEST(InputCollector, TheStickIsThatOfTheRigsHand) {
  InputCollector collector("", {.interface = UserInterface::kJoystick});
  v1::Tick tick = StickTick();
  AddStick(tick, 4, -1, -1);  // Plugged into a shin's Wiimote.
  AddStick(tick, 3, 0.3, 0.7);
  AddStick(tick, 9, 1, 1);  // Of another rig.
  EXPECT_TRUE(collector.Take(tick, kMs));
  EXPECT_EQ(collector.rig(), "main");
  EXPECT_TRUE(collector.inputs().stick.present);
  EXPECT_EQ(collector.inputs().stick.x, 0.3);
  EXPECT_TRUE(collector.inputs().simulated);
}

TEST(InputCollector, AStickThatWaitsForItsTickIsDecodedWhenItArrives) {
  InputCollector collector("", {.interface = UserInterface::kJoystick});
  v1::Tick tick = StickTick();
  AddStick(tick, 3, 0.3, 0.7);
  tick.mutable_nunchuk()->mutable_samples(0)->set_received_ns(2 * kMs);
  tick.set_host_ns(9 * kMs);
  collector.Take(tick, 10 * kMs);
  EXPECT_EQ(collector.stamps().decoded_ns, 2 * kMs);
  EXPECT_EQ(collector.stamps().computed_ns, 9 * kMs);
}

TEST(InputCollector, APressWithinOneTickCounts) {
  InputCollector collector("", {.interface = UserInterface::kJoystick});
  v1::Tick tick = StickTick();
  AddStick(tick, 3, 0, 0);
  for (const std::uint32_t buttons : {0x0u, 0x8u, 0x0u, 0x4u, 0x8u}) AddButtons(tick, 3, buttons);
  AddButtons(tick, 4, 0x8);
  collector.Take(tick, kMs);
  EXPECT_EQ(collector.inputs().stick.presses, 2u);
  EXPECT_TRUE(collector.inputs().stick.pressed);
}

TEST(InputCollector, AStickThatIsSilentIsGone) {
  InputCollector collector("", {.interface = UserInterface::kJoystick});
  v1::Tick tick = StickTick();
  AddStick(tick, 3, 0, 1);
  AddButtons(tick, 3, 0x8);
  collector.Take(tick, kMs);
  EXPECT_FALSE(collector.Take({}, 200 * kMs)) << "nothing new";
  EXPECT_TRUE(collector.inputs().stick.present);
  EXPECT_TRUE(collector.Take({}, 260 * kMs)) << "its end is new";
  EXPECT_FALSE(collector.inputs().stick.present);
  EXPECT_EQ(collector.inputs().stick.presses, 1u);
}

TEST(InputCollector, ASilentStickIsStillThatOfItsHand) {
  InputCollector collector("", {.interface = UserInterface::kJoystick});
  v1::Tick tick;
  AddDevice(tick, 3, "main", v1::DEVICE_ROLE_LEFT_HAND);
  AddDevice(tick, 4, "main", v1::DEVICE_ROLE_RIGHT_HAND);
  tick.set_snapshot(true);
  collector.Take(tick, 0);
  EXPECT_EQ(collector.inputs().stick.role, stream::DeviceRole::kUnspecified) << "either may be it";
  tick.mutable_status()->mutable_devices(0)->set_extension(v1::EXTENSION_NUNCHUK);
  collector.Take(tick, 0);
  EXPECT_EQ(collector.inputs().stick.role, stream::DeviceRole::kLeftHand);
  tick.set_snapshot(false);
  AddStick(tick, 3, 0, 1);
  collector.Take(tick, kMs);
  tick.mutable_status()->mutable_devices(0)->set_state(v1::DEVICE_STATE_LOST);
  tick.mutable_status()->mutable_devices(0)->set_extension(v1::EXTENSION_UNSPECIFIED);
  tick.clear_nunchuk();
  collector.Take(tick, 400 * kMs);
  EXPECT_FALSE(collector.inputs().stick.present);
  EXPECT_EQ(collector.inputs().stick.role, stream::DeviceRole::kLeftHand);
}

TEST(InputCollector, BoardsHaveTheirCopInTheWorldAsTheyLie) {
  InputCollector collector("", {.interface = UserInterface::kBoards});
  v1::Tick snapshot;
  snapshot.set_snapshot(true);
  AddDevice(snapshot, 1, "main", v1::DEVICE_ROLE_LEFT_BOARD);
  AddDevice(snapshot, 2, "main", v1::DEVICE_ROLE_RIGHT_BOARD);
  v1::BoardLayout& layout = *snapshot.mutable_setup()->add_rigs()->mutable_layout();
  snapshot.mutable_setup()->mutable_rigs(0)->set_rig("main");
  layout.set_preset("custom");
  layout.mutable_left()->set_x_m(0.5);
  layout.mutable_left()->set_y_m(0.3);
  EXPECT_FALSE(collector.Take(snapshot, kMs));
  v1::Tick tick;
  AddBoard(tick, 1, 25, 0.1);  // Towards its front edge, which faces forward at yaw 0.
  EXPECT_TRUE(collector.Take(tick, 2 * kMs));
  const mapping::BoardInput& board = collector.inputs().left_board;
  EXPECT_TRUE(board.present && board.cop_valid);
  EXPECT_EQ(board.LoadN(), 100);
  EXPECT_NEAR(board.cop_x_m, 0.6, 1e-12);
  EXPECT_NEAR(board.cop_y_m, 0.3, 1e-12);
  EXPECT_FALSE(collector.inputs().right_board.present);
}

TEST(InputCollector, WhatIsNotFiniteIsNotTaken) {
  InputCollector boards("", {.interface = UserInterface::kBoards});
  v1::Tick tick;
  AddDevice(tick, 1, "main", v1::DEVICE_ROLE_LEFT_BOARD);
  AddBoard(tick, 1, std::numeric_limits<double>::quiet_NaN(), 0);
  EXPECT_FALSE(boards.Take(tick, kMs));
  InputCollector stick("", {.interface = UserInterface::kJoystick});
  v1::Tick other = StickTick();
  AddStick(other, 3, std::numeric_limits<double>::infinity(), 0);
  EXPECT_FALSE(stick.Take(other, kMs));
}

TEST(InputCollector, LegsHeadAndTrunkCarryWhetherTheyAreMounted) {
  InputCollector collector("", {.interface = UserInterface::kLeg});
  v1::Tick tick;
  AddDevice(tick, 1, "main", v1::DEVICE_ROLE_LEFT_LEG, true);
  AddDevice(tick, 2, "main", v1::DEVICE_ROLE_TRUNK, false);
  v1::RigFeatures& rig = *tick.mutable_features()->add_rigs();
  rig.set_rig("main");
  for (const auto role : {v1::DEVICE_ROLE_LEFT_LEG, v1::DEVICE_ROLE_TRUNK}) {
    v1::DeviceFeatures& device = *rig.add_devices();
    device.set_role(role);
    device.set_moving(true);
  }
  EXPECT_TRUE(collector.Take(tick, kMs));
  EXPECT_TRUE(collector.inputs().legs.left.mounted);
  EXPECT_TRUE(collector.inputs().trunk.present);
  EXPECT_FALSE(collector.inputs().trunk.mounted);
}

TEST(InputCollector, ARestartedServerMayHaveAnotherRig) {
  InputCollector collector("", {.interface = UserInterface::kJoystick});
  v1::Tick tick = StickTick();
  tick.set_epoch(1);
  AddStick(tick, 3, 0, 0);
  collector.Take(tick, kMs);
  v1::Tick later;
  later.set_epoch(2);
  AddDevice(later, 1, "other", v1::DEVICE_ROLE_LEFT_HAND);
  AddStick(later, 1, 0, 1);
  EXPECT_TRUE(collector.Take(later, 400 * kMs));
  EXPECT_EQ(collector.rig(), "other");
}

TEST(InputCollector, GoesOverToAnInterfaceOfWhichARigHasTheRoles) {
  InputCollector collector("", {.interface = UserInterface::kJoystick});
  v1::Tick tick = StickTick();
  AddDevice(tick, 5, "boards", v1::DEVICE_ROLE_LEFT_BOARD);
  AddDevice(tick, 6, "boards", v1::DEVICE_ROLE_RIGHT_BOARD);
  AddStick(tick, 3, 0.3, 0.7);
  ASSERT_TRUE(collector.Take(tick, kMs));
  ASSERT_TRUE(collector.Use({.interface = UserInterface::kBoards}).ok());
  EXPECT_EQ(collector.rig(), "boards");
  EXPECT_EQ(collector.inputs(), mapping::Inputs{}) << "nothing of the stick is left";
  v1::Tick next;
  AddStick(next, 3, 1, 1);
  AddBoard(next, 5, 100, 0);
  ASSERT_TRUE(collector.Take(next, 2 * kMs));
  EXPECT_TRUE(collector.inputs().left_board.present);
  EXPECT_FALSE(collector.inputs().stick.present);
}

TEST(InputCollector, StaysAndNamesWhatIsMissingWhereNoRigFits) {
  InputCollector collector("", {.interface = UserInterface::kJoystick});
  EXPECT_NE(collector.Use({.interface = UserInterface::kWrist}).error().message.find("left_hand"),
            std::string::npos);
  v1::Tick tick = StickTick();
  AddDevice(tick, 5, "main", v1::DEVICE_ROLE_LEFT_HAND);
  tick.mutable_status()->mutable_devices(2)->set_state(v1::DEVICE_STATE_LOST);
  AddStick(tick, 3, 0.3, 0.7);
  ASSERT_TRUE(collector.Take(tick, kMs));
  const auto refused = collector.Use({.interface = UserInterface::kArm});
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().message,
            "the rig main lacks left_hand; connect the devices, or give them these roles "
            "(footing-ctl assign)");
  EXPECT_EQ(collector.options().interface, UserInterface::kJoystick);
  EXPECT_TRUE(collector.inputs().stick.present);
  tick.mutable_status()->mutable_devices(2)->set_state(v1::DEVICE_STATE_LIVE);
  ASSERT_TRUE(collector.Take(tick, 2 * kMs));
  EXPECT_TRUE(collector.Use({.interface = UserInterface::kArm}).ok());
}

TEST(InputCollector, AJoystickNeedsANunchuk) {
  InputCollector collector("", {.interface = UserInterface::kWrist});
  v1::Tick tick = StickTick();
  const std::pair<v1::Extension, bool> extensions[] = {
      {v1::EXTENSION_UNSPECIFIED, true},  {v1::EXTENSION_NONE, false},
      {v1::EXTENSION_NUNCHUK, true},      {v1::EXTENSION_CLASSIC, false},
      {v1::EXTENSION_MOTION_PLUS, false}, {v1::EXTENSION_MOTION_PLUS_NUNCHUK, true}};
  for (const auto& [extension, fits] : extensions) {
    tick.mutable_status()->mutable_devices(0)->set_extension(extension);
    tick.set_snapshot(true);
    collector.Take(tick, kMs);
    const auto used = collector.Use({.interface = UserInterface::kJoystick});
    EXPECT_EQ(used.ok(), fits) << v1::Extension_Name(extension);
    if (fits) continue;
    EXPECT_NE(used.error().message.find("Nunchuk"), std::string::npos);
  }
}

TEST(InputCollector, AnInterfaceStaysOnTheRigThatWasNamed) {
  InputCollector collector("main", {.interface = UserInterface::kJoystick});
  v1::Tick tick = StickTick();
  AddDevice(tick, 5, "boards", v1::DEVICE_ROLE_LEFT_BOARD);
  AddDevice(tick, 6, "boards", v1::DEVICE_ROLE_RIGHT_BOARD);
  AddStick(tick, 3, 0.3, 0.7);
  ASSERT_TRUE(collector.Take(tick, kMs));
  EXPECT_FALSE(collector.Use({.interface = UserInterface::kBoards}).ok());
  EXPECT_EQ(collector.rig(), "main");
}

}  // namespace
}  // namespace footing::gait_service
