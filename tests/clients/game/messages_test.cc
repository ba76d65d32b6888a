#include "clients/game/messages.h"

#include <gtest/gtest.h>

#include <limits>

#include "common/stream/user_interface.h"

namespace footing::game {
namespace {

void AddDevice(v1::Tick& tick, std::uint32_t device, v1::DeviceRole role, double roll_rad) {
  v1::DeviceFeatures& features = *tick.mutable_features()->add_rigs()->add_devices();
  features.set_device(device);
  features.set_role(role);
  features.set_inclination_valid(true);
  features.set_roll_rad(roll_rad);
  features.set_pitch_rad(-roll_rad);
}

void AddButtons(v1::Tick& tick, std::uint32_t device, std::uint32_t buttons) {
  v1::MotionSample& sample = *tick.mutable_motion()->add_samples();
  sample.set_device(device);
  sample.set_buttons(buttons);
}

TEST(Messages, TakeTheHandFromTheEditorAlone) {
  v1::Tick tick;
  AddDevice(tick, 1, v1::DEVICE_ROLE_LEFT_HAND, 0.9);
  AddDevice(tick, 7, v1::DEVICE_ROLE_EDITOR, 0.4);
  AddButtons(tick, 1, 0x000c);
  AddButtons(tick, 7, 0x0008);
  std::uint32_t device = 0;
  Hand hand;
  EXPECT_TRUE(Take(tick, device, hand));
  EXPECT_EQ(device, 7u);
  EXPECT_EQ(hand.roll_rad, 0.4);
  EXPECT_EQ(hand.pitch_rad, -0.4);
  EXPECT_TRUE(hand.a);
  EXPECT_FALSE(hand.b);
  tick.mutable_motion()->mutable_samples(1)->set_buttons(0x0004);
  Take(tick, device, hand);
  EXPECT_FALSE(hand.a);
  EXPECT_TRUE(hand.b);
}

TEST(Messages, TakeTheWholeHandFromTheFirstRigsEditor) {
  v1::Tick tick;
  AddDevice(tick, 7, v1::DEVICE_ROLE_EDITOR, 0.4);
  AddDevice(tick, 3, v1::DEVICE_ROLE_EDITOR, 0.9);
  AddButtons(tick, 3, 0x0004);
  AddButtons(tick, 7, 0x0008);
  std::uint32_t device = 0;
  Hand hand;
  EXPECT_TRUE(Take(tick, device, hand));
  EXPECT_EQ(device, 7u);
  EXPECT_EQ(hand.roll_rad, 0.4);
  EXPECT_TRUE(hand.a);
  EXPECT_FALSE(hand.b);
  // A lost device stays in its rig, without an inclination.
  tick.mutable_features()->mutable_rigs(0)->mutable_devices(0)->set_inclination_valid(false);
  EXPECT_TRUE(Take(tick, device, hand));
  EXPECT_EQ(device, 3u);
  EXPECT_EQ(hand.roll_rad, 0.9);
  EXPECT_FALSE(hand.a);
  EXPECT_TRUE(hand.b);
}

TEST(Messages, KeepTheHandWhereATickSaysNothingOfIt) {
  std::uint32_t device = 7;
  Hand hand{true, 0.4, 0.2, true};
  EXPECT_FALSE(Take(v1::Tick(), device, hand));
  EXPECT_EQ(hand.roll_rad, 0.4);
  EXPECT_TRUE(hand.a);
}

TEST(Messages, NeverTakeNumbersThatAreNotFinite) {
  v1::Tick tick;
  AddDevice(tick, 7, v1::DEVICE_ROLE_EDITOR, std::numeric_limits<double>::quiet_NaN());
  std::uint32_t device = 0;
  Hand hand;
  EXPECT_TRUE(Take(tick, device, hand));
  EXPECT_EQ(hand.roll_rad, 0);
}

TEST(Messages, TakeTheRunnersSilenceFromTheInterface) {
  v1::Tick tick;
  v1::Character& character = *tick.mutable_characters()->add_characters();
  tick.mutable_characters()->set_time_s(3);
  character.mutable_gait()->set_commanded_by_stream(true);
  character.mutable_interface()->set_activity(v1::ACTIVITY_ALTERNATE);
  EXPECT_EQ(FrameOf(tick).time_s, 3);
  EXPECT_TRUE(FrameOf(tick).commanded);
  EXPECT_FALSE(FrameOf(tick).runner_silent);
  character.mutable_interface()->set_missing_roles(stream::RoleBit(stream::DeviceRole::kHead));
  EXPECT_TRUE(FrameOf(tick).runner_silent);
  character.mutable_interface()->set_missing_roles(0);
  character.mutable_interface()->set_activity(v1::ACTIVITY_ABSENT);
  EXPECT_TRUE(FrameOf(tick).runner_silent);
}

TEST(Messages, AppendEveryPropertyOfAPiece) {
  const v1::AppendSegment append = ToCommand({2.5, 0.05, -0.2, 0.08, false}).append_segment();
  EXPECT_EQ(append.length_m(), 2.5);
  EXPECT_EQ(append.slope_rad(), 0.05);
  EXPECT_EQ(append.curve_rad(), -0.2);
  EXPECT_EQ(append.step_m(), 0.08);
  EXPECT_FALSE(append.pit());
  EXPECT_TRUE(ToCommand({0.5, 0, 0, 0, true}).append_segment().pit());
}

}  // namespace
}  // namespace footing::game
