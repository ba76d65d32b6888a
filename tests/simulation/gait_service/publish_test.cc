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
  inputs.trial = {.number = 4, .task = 2, .stopped_below = 3, .track_number = 5};

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
  EXPECT_EQ(back.inputs.engine.trial.number, 4u);
  EXPECT_EQ(back.inputs.engine.trial.task, 2);
  EXPECT_EQ(back.inputs.engine.trial.stopped_below, 3u);
  EXPECT_EQ(back.inputs.engine.trial.track_number, 5u);
}

TEST(Publish, AFailureSaysItsCauseAndAPutBackWhoAskedForIt) {
  engine::EngineEvent event;
  event.kind = engine::EventKind::kFall;
  event.text = "the body is beside the track";
  for (const auto& [cause, number] :
       {std::pair(stream::FailureCause::kSimulation, v1::FAILURE_CAUSE_SIMULATION),
        std::pair(stream::FailureCause::kCurve, v1::FAILURE_CAUSE_CURVE),
        std::pair(stream::FailureCause::kJump, v1::FAILURE_CAUSE_JUMP),
        std::pair(stream::FailureCause::kStraightness, v1::FAILURE_CAUSE_STRAIGHTNESS),
        std::pair(stream::FailureCause::kTransition, v1::FAILURE_CAUSE_TRANSITION)}) {
    event.cause = cause;
    const v1::Event message = ToEvent(event, 5);
    EXPECT_EQ(message.kind(), v1::Event::KIND_FALL);
    EXPECT_EQ(message.failure_cause(), number);
    EXPECT_EQ(message.text(),
              std::string("failure (") + stream::Name(cause) + "): the body is beside the track");
    EXPECT_FALSE(message.by_operator());
  }
  event = {};
  event.kind = engine::EventKind::kPutBack;
  event.text = "by a command";
  event.by_operator = true;
  const v1::Event put_back = ToEvent(event, 5);
  EXPECT_EQ(put_back.failure_cause(), v1::FAILURE_CAUSE_UNSPECIFIED);
  EXPECT_TRUE(put_back.by_operator());
  EXPECT_EQ(put_back.text(), "put back by a command");
}

TEST(Publish, FailuresAreCountedByCauseApartFromOperatorPutBacks) {
  Frame frame;
  frame.output.gait.falls = 10;
  frame.output.gait.failures = {1, 2, 3};
  frame.output.gait.operator_put_backs = 4;
  const v1::CharacterFrame message = ToCharacterFrame(frame, "straight", "one");
  const v1::GaitState& gait = message.characters(0).gait();
  EXPECT_EQ(gait.failures().simulation(), 1u);
  EXPECT_EQ(gait.failures().curve(), 2u);
  EXPECT_EQ(gait.failures().jump(), 3u);
  EXPECT_EQ(gait.operator_put_backs(), 4u);
  EXPECT_EQ(gait.falls(), 10u);
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
