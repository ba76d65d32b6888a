#include "daemon/simulation/gait_service/sensor_input.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace footing::gait_service {
namespace {

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
