#include "clients/stream/plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace footing::stream_client {
namespace {

using testing::HasSubstr;

TEST(Plan, AUserSwingsALeftAndARightWiimoteOfTheirOwnSerials) {
  const auto plan = PlanUser("demo", "wrist", {});
  ASSERT_TRUE(plan);
  ASSERT_EQ(plan->devices.size(), 2u);
  EXPECT_EQ(plan->devices[0].role(), stream::DeviceRole::kLeftHand);
  EXPECT_EQ(plan->devices[1].role(), stream::DeviceRole::kRightHand);
  EXPECT_NE(plan->devices[0].identity().serial, plan->devices[1].identity().serial);
}

TEST(Plan, AnInterfaceNotBuiltIsAUsageErrorThatListsWhatIs) {
  const auto plan = PlanUser("demo", "leg", {});
  ASSERT_FALSE(plan);
  EXPECT_EQ(plan.error().kind, ErrorKind::kUsage);
  EXPECT_THAT(plan.error().message, HasSubstr("there are: wrist, joystick"));
}

TEST(Plan, AnUnknownLinkIsRefused) {
  Common common;
  common.link = "perfect";
  const auto plan = PlanUser("demo", "wrist", common);
  ASSERT_FALSE(plan);
  EXPECT_THAT(plan.error().message, HasSubstr("ideal, good and poor"));
}

TEST(Plan, AMissingRecordingIsNamed) {
  const auto plan = PlanAccelerations("/nonexistent/left.csv", "", 100, {});
  ASSERT_FALSE(plan);
  EXPECT_THAT(plan.error().message, HasSubstr("/nonexistent/left.csv"));
}

TEST(Plan, TheSameSeedMakesTheSameSerials) {
  const auto one = PlanUser("demo", "wrist", {});
  const auto two = PlanUser("demo", "wrist", {});
  ASSERT_TRUE(one && two);
  EXPECT_EQ(one->devices[0].identity().serial, two->devices[0].identity().serial);
}

}  // namespace
}  // namespace footing::stream_client
