#include "daemon/sensor/service/binding.h"

#include <gtest/gtest.h>

namespace footing::sensor {
namespace {

using stream::DeviceKind;
using stream::DeviceRole;

TEST(Binding, IsRigAndRole) {
  const auto binding = ParseBinding("left player/right_leg");
  ASSERT_TRUE(binding);
  EXPECT_EQ(*binding, (Binding{"left player", DeviceRole::kRightLeg}));
  for (const char* text : {"", "main", "/left_hand", "main/", "main/nose", "main/left_hand/x"}) {
    EXPECT_FALSE(ParseBinding(text)) << text;
  }
}

TEST(Binding, RolesAreGivenInOrderOnEachRig) {
  std::vector<Binding> taken;
  for (const DeviceRole role : {DeviceRole::kLeftHand, DeviceRole::kRightHand, DeviceRole::kLeftLeg,
                                DeviceRole::kRightLeg, DeviceRole::kHead}) {
    EXPECT_EQ(FirstFreeRole(DeviceKind::kWiimote, "main", taken), role);
    taken.push_back({"main", role});
  }
  EXPECT_EQ(FirstFreeRole(DeviceKind::kWiimote, "main", taken), DeviceRole::kUnspecified);
  EXPECT_EQ(FirstFreeRole(DeviceKind::kWiimote, "other", taken), DeviceRole::kLeftHand);
  EXPECT_EQ(FirstFreeRole(DeviceKind::kBalanceBoard, "main", taken), DeviceRole::kLeftBoard);
}

TEST(Binding, ABoardIsNoHandAndAWiimoteNoBoard) {
  EXPECT_TRUE(RoleFits(DeviceKind::kWiimote, DeviceRole::kEditor));
  EXPECT_TRUE(RoleFits(DeviceKind::kBalanceBoard, DeviceRole::kRightBoard));
  EXPECT_FALSE(RoleFits(DeviceKind::kBalanceBoard, DeviceRole::kLeftHand));
  EXPECT_FALSE(RoleFits(DeviceKind::kWiimote, DeviceRole::kLeftBoard));
}

}  // namespace
}  // namespace footing::sensor
