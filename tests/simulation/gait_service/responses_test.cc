#include "daemon/simulation/gait_service/responses.h"

#include <gtest/gtest.h>

namespace footing::gait_service {
namespace {

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
