#include "daemon/sensor/service/device.h"

#include <gtest/gtest.h>

namespace footing::sensor {
namespace {

using decode::Placement;
using stream::DeviceRole;

TEST(Binding, IsRigAndRole) {
  const auto binding = ParseBinding("left player/right_leg");
  ASSERT_TRUE(binding);
  EXPECT_EQ(*binding, (Binding{"left player", DeviceRole::kRightLeg}));
  for (const char* text : {"", "main", "/left_hand", "main/", "main/nose", "main/left_hand/x"}) {
    EXPECT_FALSE(ParseBinding(text)) << text;
  }
}

TEST(Binding, WhatIsWrongIsNamed) {
  const auto why = [](const std::string& text) { return ParseBinding(text).error().message; };
  EXPECT_NE(why("main/nose").find("role 'nose' does not exist; there are left_hand"),
            std::string::npos);
  EXPECT_NE(why(std::string(65, 'r') + "/head").find("must be 1 to 64 bytes"), std::string::npos);
  EXPECT_NE(why("a\x1b/head").find("'a?' must be 1 to 64 bytes without control"),
            std::string::npos);
  EXPECT_EQ(ParseBinding("a/b/head").value(), (Binding{"a/b", DeviceRole::kHead}));
}

TEST(Binding, RolesAreGivenInOrderOnEachRig) {
  std::vector<Binding> taken;
  for (const DeviceRole role : {DeviceRole::kLeftHand, DeviceRole::kRightHand, DeviceRole::kLeftLeg,
                                DeviceRole::kRightLeg, DeviceRole::kHead, DeviceRole::kTrunk}) {
    EXPECT_EQ(FirstFreeRole(Placement::kOnBody, "main", taken), role);
    taken.push_back({"main", role});
  }
  EXPECT_EQ(FirstFreeRole(Placement::kOnBody, "main", taken), DeviceRole::kUnspecified);
  EXPECT_EQ(FirstFreeRole(Placement::kOnBody, "other", taken), DeviceRole::kLeftHand);
  EXPECT_EQ(FirstFreeRole(Placement::kUnderFeet, "main", taken), DeviceRole::kLeftBoard);
}

TEST(Binding, ABoardIsNoHandAndAWiimoteNoBoard) {
  EXPECT_TRUE(RoleFits(Placement::kOnBody, DeviceRole::kEditor));
  EXPECT_TRUE(RoleFits(Placement::kUnderFeet, DeviceRole::kRightBoard));
  EXPECT_FALSE(RoleFits(Placement::kUnderFeet, DeviceRole::kLeftHand));
  EXPECT_FALSE(RoleFits(Placement::kOnBody, DeviceRole::kLeftBoard));
}

}  // namespace
}  // namespace footing::sensor
