#include "daemon/simulation/gait_service/publish.h"

#include <gtest/gtest.h>

namespace footing::gait_service {
namespace {

TEST(Publish, AppliedInputsComeBackBitForBit) {
  Applied applied;
  applied.step = 1234;
  applied.inputs.sensor_epoch = 5;
  applied.inputs.sensor_sequence = 6;
  engine::EngineInputs& inputs = applied.inputs.engine;
  inputs.features_number = 7;
  inputs.features.left = {true, true, true, 1.0 / 3, true, 7.7, true, -0.1};
  inputs.features.right = {true, false, false, 0, false, 0, true, 0.2};
  inputs.features.phase_valid = true;
  inputs.features.phase_rad = 3.14159;
  inputs.features.simulated = true;
  inputs.direct = true;
  inputs.direct_command = {stream::Gait::kJump, 0.7, 0.3, -0.087};
  inputs.push_number = 2;
  inputs.push_impulse_W_ns = {1.5, -2.5};
  inputs.put_back_number = 3;
  inputs.append_number = 9;
  inputs.append_count = 2;
  inputs.appends[0] = {2.5, 0.05, -0.2, 0.1, false};
  inputs.appends[1] = {1.5, 0, 0, 0, true};

  const std::string bytes = ToAppliedInput(applied).SerializeAsString();
  v1::AppliedInput message;
  ASSERT_TRUE(message.ParseFromString(bytes));
  const Applied back = FromAppliedInput(message);
  EXPECT_EQ(ToAppliedInput(back).SerializeAsString(), bytes);
  EXPECT_EQ(back.inputs.engine.features.left.frequency_hz, 1.0 / 3);
  EXPECT_EQ(back.inputs.engine.direct_command, inputs.direct_command);
  ASSERT_EQ(back.inputs.engine.append_count, 2);
  EXPECT_EQ(back.inputs.engine.appends[0].step_m, 0.1);
  EXPECT_TRUE(back.inputs.engine.appends[1].pit);
}

TEST(Publish, AFrameCarriesEveryLinkAndContact) {
  Frame frame;
  frame.output.step = 10;
  frame.output.state_hash = 99;
  frame.output.gait.phase = "rise";
  frame.overruns = 4;
  const v1::CharacterFrame message = ToCharacterFrame(frame, "straight", "one");
  ASSERT_EQ(message.characters_size(), 1);
  EXPECT_EQ(message.characters(0).links_size(), engine::kLinkCount);
  EXPECT_EQ(message.characters(0).contacts_size(), engine::kContactCount);
  EXPECT_EQ(message.characters(0).gait().phase(), "rise");
  EXPECT_EQ(message.state_hash(), 99u);
  EXPECT_EQ(message.overruns(), 4u);
}

}  // namespace
}  // namespace footing::gait_service
