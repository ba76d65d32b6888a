#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "daemon/simulation/gait_service/input_collector.h"

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
  AddStick(tick, 9, 1, 1);  // Stick of another rig.
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
  EXPECT_EQ(board.corners_n[0] + board.corners_n[1] + board.corners_n[2] + board.corners_n[3], 100);
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

using testing::HasSubstr;

v1::RigFeatures* AddRig(v1::Tick& tick, const std::string& name, v1::DeviceRole role) {
  v1::RigFeatures* rig = tick.mutable_features()->add_rigs();
  rig->set_rig(name);
  v1::DeviceFeatures* device = rig->add_devices();
  device->set_device(1);
  device->set_role(role);
  device->set_moving(true);
  device->set_frequency_valid(true);
  device->set_frequency_hz(1.5);
  return rig;
}

constexpr std::uint64_t kSession = 3;

struct Fixture : testing::Test {
  exchange::Latest<Inputs> inputs;
  Responses responses;
};

using SensorInputTest = Fixture;

TEST_F(SensorInputTest, FollowsTheFirstRigThatHasHands) {
  SensorInput input("", {}, inputs, responses);
  v1::Tick tick;
  tick.set_epoch(9);
  tick.set_sequence(41);
  AddRig(tick, "boards", v1::DEVICE_ROLE_LEFT_BOARD);
  AddRig(tick, "one", v1::DEVICE_ROLE_RIGHT_HAND);
  input.OnTick(tick, 1);
  ASSERT_TRUE(inputs.Refresh());
  EXPECT_EQ(input.rig(), "one");
  EXPECT_EQ(inputs.Front().engine.features_number, 1u);
  EXPECT_EQ(inputs.Front().sensor_sequence, 41u);
  EXPECT_EQ(inputs.Front().sensor_epoch, 9u);
  EXPECT_DOUBLE_EQ(inputs.Front().engine.features.hands.right.frequency_hz, 1.5);
}

TEST_F(SensorInputTest, FollowsOnlyTheRigThatWasNamed) {
  SensorInput input("two", {}, inputs, responses);
  v1::Tick tick;
  AddRig(tick, "one", v1::DEVICE_ROLE_LEFT_HAND);
  input.OnTick(tick, 1);
  ASSERT_TRUE(inputs.Refresh());
  EXPECT_EQ(inputs.Front().engine.features, mapping::Inputs{});
}

TEST_F(SensorInputTest, TicksWithoutTheRigsDevicesSayThatFootingdAnswers) {
  using stream::UserInterface;
  constexpr std::int64_t kMs = 1'000'000;
  for (const UserInterface interface :
       {UserInterface::kWrist, UserInterface::kJoystick, UserInterface::kBoards}) {
    SensorInput input("", {.interface = interface}, inputs, responses);
    v1::Tick first;
    AddRig(first, "main", v1::DEVICE_ROLE_LEFT_HAND);
    v1::DeviceStatus& device = *first.mutable_status()->add_devices();
    device.set_device(1);
    device.set_rig("main");
    device.set_role(interface == UserInterface::kBoards ? v1::DEVICE_ROLE_LEFT_BOARD
                                                        : v1::DEVICE_ROLE_LEFT_HAND);
    first.mutable_nunchuk()->add_samples()->set_device(1);
    first.mutable_boards()->add_samples()->set_device(1);
    input.OnTick(first, 100 * kMs);
    for (int i = 1; i <= 100; ++i) input.OnTick({}, (100 + 10 * i) * kMs);
    ASSERT_TRUE(inputs.Refresh());
    const engine::EngineInputs& engine = inputs.Front().engine;
    EXPECT_EQ(engine.features_number, 101u) << stream::Name(interface);
    EXPECT_FALSE(engine.features.hands.left.present);
    EXPECT_FALSE(engine.features.stick.present);
    EXPECT_FALSE(engine.features.left_board.present);
  }
}

TEST_F(SensorInputTest, SnapshotsAndRefilledTicksAreThePastAndCommandNothing) {
  SensorInput input("", {}, inputs, responses);
  v1::Tick tick;
  AddRig(tick, "one", v1::DEVICE_ROLE_LEFT_HAND);
  tick.set_snapshot(true);
  input.OnTick(tick, 1);
  tick.set_snapshot(false);
  tick.set_refilled(true);
  input.OnTick(tick, 2);
  EXPECT_FALSE(inputs.Refresh());
}

TEST_F(SensorInputTest, DirectGaitTakesOverAndIsReleased) {
  SensorInput input("", {}, inputs, responses);
  v1::Command command;
  command.mutable_direct_gait()->set_gait(v1::GAIT_RUN);
  command.mutable_direct_gait()->set_speed_mps(2);
  EXPECT_TRUE(input.OnCommand(command, kSession).ok());
  ASSERT_TRUE(inputs.Refresh());
  EXPECT_TRUE(inputs.Front().engine.direct);
  EXPECT_EQ(inputs.Front().engine.direct_command.gait, stream::Gait::kRun);
  command.mutable_direct_gait()->set_release(true);
  EXPECT_TRUE(input.OnCommand(command, kSession).ok());
  ASSERT_TRUE(inputs.Refresh());
  EXPECT_FALSE(inputs.Front().engine.direct);
}

TEST_F(SensorInputTest, DirectGaitEndsWithTheSessionThatSentIt) {
  SensorInput input("", {}, inputs, responses);
  v1::Command command;
  command.mutable_direct_gait()->set_gait(v1::GAIT_RUN);
  EXPECT_TRUE(input.OnCommand(command, kSession).ok());
  input.OnSessionEnd(kSession + 1);  // Another client.
  ASSERT_TRUE(inputs.Refresh());
  EXPECT_TRUE(inputs.Front().engine.direct);
  input.OnSessionEnd(kSession);
  ASSERT_TRUE(inputs.Refresh());
  EXPECT_FALSE(inputs.Front().engine.direct);
}

TEST_F(SensorInputTest, CommandsThatMakeNoSenseAreRefusedAndChangeNothing) {
  SensorInput input("", {}, inputs, responses);
  v1::Command no_gait;
  no_gait.mutable_direct_gait();
  EXPECT_FALSE(input.OnCommand(no_gait, kSession).ok());
  v1::Command not_finite;
  not_finite.mutable_direct_gait()->set_gait(v1::GAIT_WALK);
  not_finite.mutable_direct_gait()->set_speed_mps(std::numeric_limits<double>::quiet_NaN());
  EXPECT_FALSE(input.OnCommand(not_finite, kSession).ok());
  v1::Command too_hard;
  too_hard.mutable_push()->set_impulse_x_ns(1e6);
  EXPECT_THAT(input.OnCommand(too_hard, kSession).message(), HasSubstr("200 N s"));
  v1::Command rumble;
  rumble.mutable_set_rumble();
  EXPECT_THAT(input.OnCommand(rumble, kSession).message(),
              HasSubstr("footing-sim --engine gait takes"));
  v1::Command t_pose;
  t_pose.mutable_calibrate_t_pose();
  EXPECT_THAT(input.OnCommand(t_pose, kSession).message(),
              HasSubstr("for footing-sim --engine pose"));
  EXPECT_FALSE(inputs.Refresh());
}

TEST_F(SensorInputTest, EachPushHasItsOwnNumber) {
  SensorInput input("", {}, inputs, responses);
  v1::Command push;
  push.mutable_push()->set_impulse_y_ns(5);
  EXPECT_TRUE(input.OnCommand(push, kSession).ok());
  EXPECT_TRUE(input.OnCommand(push, kSession).ok());
  ASSERT_TRUE(inputs.Refresh());
  EXPECT_EQ(inputs.Front().engine.push_number, 2u);
  EXPECT_DOUBLE_EQ(inputs.Front().engine.push_impulse_W_ns.y(), 5);
}

v1::Command AppendOf(double length_m) {
  v1::Command command;
  command.mutable_append_segment()->set_length_m(length_m);
  return command;
}

TEST_F(SensorInputTest, SegmentsWaitInOrderUntilTheEngineHasTakenThem) {
  SensorInput input("", {}, inputs, responses);
  for (int i = 0; i < engine::kMaxAppends; ++i) {
    EXPECT_TRUE(input.OnCommand(AppendOf(2 + 0.1 * i), kSession).ok());
  }
  const v1::CommandResult full = input.OnCommand(AppendOf(3), kSession);
  EXPECT_FALSE(full.ok());
  EXPECT_THAT(full.message(), HasSubstr("try again"));

  Frame frame;
  frame.output.append.number = 5;
  input.OnFrame(frame);
  EXPECT_TRUE(input.OnCommand(AppendOf(4), kSession).ok());
  ASSERT_TRUE(inputs.Refresh());
  const engine::EngineInputs& engine = inputs.Front().engine;
  EXPECT_EQ(engine.append_number, 17u);
  ASSERT_EQ(engine.append_count, 12);
  EXPECT_DOUBLE_EQ(engine.appends[0].length_m, 2.5);  // The sixth.
  EXPECT_DOUBLE_EQ(engine.appends[11].length_m, 4);
}

TEST_F(SensorInputTest, ASegmentMustBeFinite) {
  SensorInput input("", {}, inputs, responses);
  EXPECT_FALSE(input.OnCommand(AppendOf(std::numeric_limits<double>::quiet_NaN()), kSession).ok());
  EXPECT_FALSE(inputs.Refresh());
}

}  // namespace
}  // namespace footing::gait_service
