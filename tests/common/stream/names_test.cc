#include <gtest/gtest.h>

#include "common/stream/character.h"
#include "common/stream/device.h"
#include "common/stream/game_state.h"
#include "common/stream/roles.h"
#include "common/stream/setup.h"
#include "common/stream/user_interface.h"

namespace footing::stream {
namespace {

TEST(Names, AreThoseOfTheProtocolInLowerCase) {
  EXPECT_STREQ(Name(DeviceKind::kPsMove), "ps_move");
  EXPECT_STREQ(Name(DeviceKind::kUnspecified), "unknown");
  EXPECT_STREQ(Name(DeviceState::kLive), "live");
  EXPECT_STREQ(Name(CalibrationOrigin::kDeviceCopy), "device_copy");
  EXPECT_STREQ(Name(TrialPhase::kFinished), "finished");
  EXPECT_STREQ(Name(FailureCause::kStraightness), "straightness");
  EXPECT_STREQ(Name(TurnSource::kLean), "lean");
}

TEST(Names, AreOthersWhereTheTableSaysSo) {
  EXPECT_STREQ(Name(Extension::kUnknown), "other");
  EXPECT_STREQ(Name(Extension::kUnspecified), "unknown");
  EXPECT_STREQ(Name(DeviceRole::kUnspecified), "none");
  EXPECT_STREQ(Name(Gesture::kLean), "lean forward");
  EXPECT_STREQ(Name(Gesture::kTakeSteps), "take steps");
  EXPECT_STREQ(Name(Gesture::kUnspecified), "none");
  EXPECT_STREQ(Name(GamePhase::kUnspecified), "unspecified");
}

TEST(Names, OfANumberThatIsNotKnownAreThatOfUnspecified) {
  EXPECT_STREQ(Name(static_cast<DeviceRole>(99)), "none");
  EXPECT_STREQ(Name(static_cast<Gait>(-1)), "unknown");
}

TEST(Names, LeadBackToTheirValues) {
  for (const DeviceRole role : kDeviceRoles) EXPECT_EQ(RoleNamed(Name(role)), role);
  for (const Gait gait : kGaits) EXPECT_EQ(GaitNamed(Name(gait)), gait);
  for (const UserInterface interface : kUserInterfaces) {
    EXPECT_EQ(UserInterfaceNamed(Name(interface)), interface);
  }
  EXPECT_EQ(RoleNamed("none"), DeviceRole::kUnspecified);
  EXPECT_EQ(GaitNamed(""), Gait::kUnspecified);
}

TEST(Names, AreListedForErrors) {
  EXPECT_EQ(GaitNames(), "step, walk, run, jump");
  EXPECT_EQ(UserInterfaceNames(), "wrist, arm, leg, joystick, boards");
  EXPECT_EQ(RoleNames(RoleBit(DeviceRole::kHead) | RoleBit(DeviceRole::kLeftHand)),
            "left_hand, head");
  EXPECT_EQ(RoleNames().substr(0, 22), "left_hand, right_hand,");
}

TEST(DrivingRoles, AreThoseOfTheLimbsThatMoveTheCharacter) {
  EXPECT_EQ(RoleNames(DrivingRoles(UserInterface::kArm)), "left_hand, right_hand");
  EXPECT_EQ(RoleNames(DrivingRoles(UserInterface::kLeg)), "left_leg, right_leg");
  EXPECT_EQ(RoleNames(DrivingRoles(UserInterface::kBoards)), "left_board, right_board");
  EXPECT_EQ(RoleNames(DrivingRoles(UserInterface::kUnspecified)), "");
}

}  // namespace
}  // namespace footing::stream
