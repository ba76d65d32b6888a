#include "daemon/sensor/service/device.h"

#include <gtest/gtest.h>

#include "common/virtual/devices/wiimote.h"
#include "daemon/sensor/service/rigs.h"

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
  EXPECT_TRUE(IsOnBody(DeviceRole::kTrunk));
  EXPECT_FALSE(IsOnBody(DeviceRole::kEditor));
  EXPECT_FALSE(IsOnBody(DeviceRole::kLeftUpperArm));
}

/// A table of Wiimotes with these serials, attached but for those that begin with "lost".
DeviceTable Wiimotes(const std::vector<std::string>& serials) {
  DeviceTable devices;
  const virtual_devices::Wiimote made(1);
  const auto& own = made.identity();
  devices::DeviceHandle handle = 0;
  for (const std::string& serial : serials) {
    devices::DeviceIdentity identity;
    identity.vendor = own.vendor;
    identity.product = own.product;
    identity.name = own.name;
    identity.serial = serial;
    Device& device = *devices.Add(false, {}, nullptr);
    device.Attach(++handle, identity);
    if (serial.starts_with("lost")) device.Detach(handle, "pulled");
  }
  return devices;
}

TEST(DeviceTable, FindsByHandleNumberAndSerialAndAnswersWhichAreAttached) {
  const DeviceTable devices = Wiimotes({"a", "lost b"});
  EXPECT_EQ(devices.Find(1), devices.WithSerial("a"));
  EXPECT_EQ(devices.Find(2), nullptr) << "a handle that is gone is nobody's";
  EXPECT_EQ(devices.Numbered(2), devices.WithSerial("lost b"));
  EXPECT_EQ(devices.Attached("a").value(), devices.Attached(1).value());
  EXPECT_EQ(devices.Attached("lost b").error().kind, ErrorKind::kNoDevice);
  EXPECT_EQ(devices.Attached(3).error().kind, ErrorKind::kNoDevice);
}

TEST(RoleAssignment, ACommandReplacesTheConfigAndTheRestTakesWhatIsFree) {
  std::vector<std::string> lines;
  RoleAssignment roles({{"a", "main/left_hand"}}, {{"a", "main/right_hand"}, {"b", "nowhere"}},
                       [&](const LogLine& line) { lines.push_back(line.text); });
  EXPECT_EQ(lines.size(), 2u) << "of a, which differs from the config, and of b";
  const DeviceTable devices = Wiimotes({"a", "b", "lost c"});
  Device& a = *devices.WithSerial("a");
  a.set_binding(roles.Choose(a, devices, "main"));
  EXPECT_EQ(a.binding(), (Binding{"main", DeviceRole::kRightHand}));
  Device& b = *devices.WithSerial("b");
  EXPECT_EQ(roles.Choose(b, devices, "main"), (Binding{"main", DeviceRole::kLeftHand}));
  devices.WithSerial("lost c")->set_binding({"main", DeviceRole::kHead});
  b.set_binding({"main", DeviceRole::kHead});
  EXPECT_EQ(roles.Choose(b, devices, "main"), b.binding()) << "one that comes back keeps its role";
  roles.Assign("b", {"other", DeviceRole::kLeftLeg});
  EXPECT_EQ(roles.Choose(b, devices, "main"), (Binding{"other", DeviceRole::kLeftLeg}));
}

}  // namespace
}  // namespace footing::sensor
