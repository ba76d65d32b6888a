#include "daemon/simulation/gait_service/applied_input.h"

#include <gtest/gtest.h>

namespace footing::gait_service {
namespace {

mapping::Inputs AllInputs() {
  mapping::Inputs inputs;
  inputs.hands.left = {true, true, true, 1.0 / 3, true, 7.7, true, -0.1, 0.4, true, 0.3, true};
  inputs.hands.right = {true, false, false, 0, false, 0, true, 0.2, 0, false, 0, false};
  inputs.hands.phase_valid = true;
  inputs.hands.phase_rad = 3.14159;
  inputs.legs.left = {true, true, true, 2.0 / 7, true, 9, true, 0.01, 0.02, false, 0, true};
  inputs.legs.phase_rad = -1.5;
  inputs.head = {true, false, false, 0, false, 0, true, 0.3, -0.2, false, 0, false};
  inputs.trunk = {true, true, false, 0, true, 3, true, -0.3, 0, true, 0.5, true};
  inputs.stick = {true, -0.7, 0.1, true, 12, stream::DeviceRole::kLeftHand};
  inputs.left_board = {true, {100.1, 200.2, 300.3, -4.4}, true, 0.02, 0.17};
  inputs.right_board = {true, {1, 2, 3, 4}, false, 0, 0};
  inputs.simulated = true;
  return inputs;
}

TEST(AppliedInput, ComesBackBitForBit) {
  Applied applied;
  applied.step = 1234;
  applied.inputs.sensor_epoch = 5;
  applied.inputs.sensor_sequence = 6;
  engine::EngineInputs& inputs = applied.inputs.engine;
  inputs.features_number = 7;
  inputs.features = AllInputs();
  inputs.direct = true;
  inputs.direct_command = {stream::Gait::kJump, 0.7, 0.3, -0.087};
  inputs.push_number = 2;
  inputs.push_impulse_W_ns = {1.5, -2.5};
  inputs.put_back_number = 3;
  inputs.append_number = 9;
  inputs.append_count = 2;
  inputs.appends[0] = {2.5, 0.05, -0.2, 0.1, false};
  inputs.appends[1] = {1.5, 0, 0, 0, true};
  inputs.trial = {.number = 4, .task = 2, .stopped_below = 3, .track_number = 5};

  const std::string bytes = ToAppliedInput(applied).SerializeAsString();
  v1::AppliedInput message;
  ASSERT_TRUE(message.ParseFromString(bytes));
  const Applied back = FromAppliedInput(message);
  EXPECT_EQ(ToAppliedInput(back).SerializeAsString(), bytes);
  EXPECT_EQ(back.inputs.engine.features, inputs.features);
  EXPECT_EQ(back.inputs.engine.direct_command, inputs.direct_command);
  ASSERT_EQ(back.inputs.engine.append_count, 2);
  EXPECT_EQ(back.inputs.engine.appends[0].step_m, 0.1);
  EXPECT_TRUE(back.inputs.engine.appends[1].pit);
  EXPECT_EQ(back.inputs.engine.trial.number, 4u);
  EXPECT_EQ(back.inputs.engine.trial.task, 2);
  EXPECT_EQ(back.inputs.engine.trial.stopped_below, 3u);
  EXPECT_EQ(back.inputs.engine.trial.track_number, 5u);
}

TEST(AppliedInput, WhatIsNotThereTakesNoSpace) {
  const v1::AppliedInput message = ToAppliedInput({});
  EXPECT_FALSE(message.has_left_leg());
  EXPECT_FALSE(message.has_head());
  EXPECT_FALSE(message.has_stick());
  EXPECT_FALSE(message.has_left_board());
}

TEST(AppliedInput, NamesItsInterface) {
  Applied applied;
  engine::InterfaceInputs& sent = applied.inputs.engine.interface;
  sent.number = 3;
  sent.options = {.interface = stream::UserInterface::kBoards,
                  .leg = {.turn_by = stream::TurnSource::kFeet},
                  .boards_may_be_left = true};
  const engine::InterfaceInputs back =
      FromAppliedInput(ToAppliedInput(applied)).inputs.engine.interface;
  EXPECT_EQ(back.number, 3u);
  EXPECT_EQ(back.options.interface, stream::UserInterface::kBoards);
  EXPECT_EQ(back.options.leg.turn_by, stream::TurnSource::kFeet);
  EXPECT_TRUE(back.options.boards_may_be_left);
}

TEST(AppliedInput, OfAnOldRecordingIsOfTheWrists) {
  const engine::InterfaceInputs old = FromAppliedInput({}).inputs.engine.interface;
  EXPECT_EQ(old.options.interface, stream::UserInterface::kWrist);
  EXPECT_EQ(old.options.leg.turn_by, stream::TurnSource::kHead);
}

}  // namespace
}  // namespace footing::gait_service
