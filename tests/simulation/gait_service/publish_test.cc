#include <gtest/gtest.h>

#include "daemon/simulation/gait_service/publish.h"

namespace footing::gait_service {
namespace {

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

TEST(Publish, AFrameNamesTheInterfaceAndWhatItBelieves) {
  Frame frame;
  frame.output.interface.interface = stream::UserInterface::kLeg;
  frame.output.interface.activity = stream::Activity::kAlternate;
  frame.output.interface.turn.source = stream::TurnSource::kTrunk;
  frame.output.interface.turn.share = -1.5;
  const v1::CharacterFrame message = ToCharacterFrame(frame, "straight", "one");
  const v1::InterfaceState& state = message.characters(0).interface();
  EXPECT_EQ(state.interface(), v1::USER_INTERFACE_LEG);
  EXPECT_EQ(state.activity(), v1::ACTIVITY_ALTERNATE);
  EXPECT_EQ(state.turn_source(), v1::TURN_SOURCE_TRUNK);
  EXPECT_EQ(state.turn_share(), -1.5);
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

Frame FrameAt(std::uint64_t commanded_step, std::uint64_t features, std::uint64_t taken_over_step) {
  Frame frame;
  frame.output.response.commanded = commanded_step;
  frame.output.response.features_number = features;
  frame.output.response.taken_over = taken_over_step;
  frame.output.gait.gait = stream::Gait::kWalk;
  frame.command_ns = 60;
  frame.contact_ns = 70;
  return frame;
}

TEST(Responses, TheFirstFrameAfterTheTakeOverCompletesTheStages) {
  Responses responses;
  responses.Received({3, 10, 20, 30, 40});
  v1::ResponseStages stages;
  EXPECT_FALSE(responses.Complete(FrameAt(100, 3, 0), 65, stages));
  ASSERT_TRUE(responses.Complete(FrameAt(100, 3, 150), 80, stages));
  EXPECT_EQ(stages.from(), v1::GAIT_STEP);
  EXPECT_EQ(stages.to(), v1::GAIT_WALK);
  EXPECT_EQ(stages.report_received_ns(), 10);
  EXPECT_EQ(stages.decoded_ns(), 20);
  EXPECT_EQ(stages.features_computed_ns(), 30);
  EXPECT_EQ(stages.features_received_ns(), 40);
  EXPECT_EQ(stages.command_ns(), 60);
  EXPECT_EQ(stages.contact_ns(), 70);
  EXPECT_EQ(stages.first_frame_ns(), 80);
  EXPECT_FALSE(responses.Complete(FrameAt(100, 3, 150), 90, stages)) << "only once";
}

TEST(Responses, ACommandThatCameFromNoFeaturesHasNoStages) {
  Responses responses;
  v1::ResponseStages stages;
  EXPECT_FALSE(responses.Complete(FrameAt(100, 0, 150), 80, stages));
}

}  // namespace
}  // namespace footing::gait_service
