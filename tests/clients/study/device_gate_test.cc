#include "clients/study/plan/device_gate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace footing::study::gate {
namespace {

using stream::DeviceRole;
using stream::DeviceState;
using stream::DeviceStatus;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

DeviceStatus Good(DeviceRole role) {
  DeviceStatus device;
  device.serial = "00:1f";
  device.role = role;
  device.state = DeviceState::kLive;
  device.report_rate_hz = 98;
  device.battery_fraction = 0.8;
  return device;
}

std::vector<DeviceStatus> Hands() {
  return {Good(DeviceRole::kLeftHand), Good(DeviceRole::kRightHand)};
}

TEST(DeviceGate, OpensForGoodDevices) {
  EXPECT_THAT(Problems({}, {"wrist"}, Hands()), IsEmpty());
  EXPECT_THAT(Problems({}, {"arm"}, Hands()), IsEmpty());
}

TEST(DeviceGate, KnowsASimulatedDeviceOfTheInterface) {
  auto devices = Hands();
  EXPECT_FALSE(AnySimulated({"wrist"}, devices));
  devices.front().simulated = true;
  EXPECT_TRUE(AnySimulated({"wrist"}, devices));
  EXPECT_FALSE(AnySimulated({"joystick"}, devices));  // In the right hand.
  EXPECT_FALSE(AnySimulated({"leg"}, devices));
}

TEST(DeviceGate, NeedsTheRolesOfTheInterface) {
  EXPECT_THAT(Problems({}, {"leg"}, Hands()),
              ElementsAre(HasSubstr("left_leg is missing"), HasSubstr("right_leg is missing"),
                          HasSubstr("head is missing")));
  EXPECT_THAT(Problems({}, {"joystick"}, {}), ElementsAre(HasSubstr("right_hand is missing")));
}

/// The hands' Wiimotes of another interface are no joystick.
TEST(DeviceGate, NeedsTheNunchukOfAJoystickInEitherHand) {
  auto devices = Hands();
  EXPECT_THAT(Problems({}, {"joystick"}, devices),
              ElementsAre(HasSubstr("right_hand (00:1f) has no Nunchuk; plug one into it")));
  for (DeviceStatus& device : devices) {
    device.extension = stream::Extension::kNunchuk;
    EXPECT_THAT(Problems({}, {"joystick"}, devices), IsEmpty()) << stream::Name(device.role);
    EXPECT_THAT(Problems({}, {"joystick"}, {device}), IsEmpty()) << stream::Name(device.role);
    device.extension = stream::Extension::kNone;
  }
  devices.back().extension = stream::Extension::kMotionPlusNunchuk;
  EXPECT_THAT(Problems({}, {"joystick"}, devices), IsEmpty());
  DeviceStatus joycon = Good(DeviceRole::kLeftHand);
  joycon.kind = stream::DeviceKind::kJoyConLeft;
  EXPECT_THAT(Problems({}, {"joystick"}, {joycon}), IsEmpty()) << "it has a stick of its own";
}

TEST(DeviceGate, NeedsOfTheLegsWhatTurns) {
  const std::vector<DeviceStatus> legs{Good(DeviceRole::kLeftLeg), Good(DeviceRole::kRightLeg)};
  EXPECT_THAT(Problems({}, {"leg", "head"}, legs), ElementsAre(HasSubstr("head is missing")));
  EXPECT_THAT(Problems({}, {"leg", "trunk"}, legs), ElementsAre(HasSubstr("trunk is missing")));
  EXPECT_THAT(Problems({}, {"leg", "feet"}, legs), IsEmpty());
  auto with_head = legs;
  with_head.push_back(Good(DeviceRole::kHead));
  EXPECT_THAT(Problems({}, {"leg", "head"}, with_head), IsEmpty());
  EXPECT_THAT(Problems({}, {"leg", "trunk"}, with_head), testing::SizeIs(1));
}

TEST(DeviceGate, WarnsOfAMissingMountingOrTare) {
  std::vector<DeviceStatus> worn{Good(DeviceRole::kLeftLeg), Good(DeviceRole::kRightLeg),
                                 Good(DeviceRole::kHead), Good(DeviceRole::kTrunk)};
  worn[0].mounted = true;
  EXPECT_THAT(Warnings({"leg", "head"}, worn),
              ElementsAre(AllOf(HasSubstr("without a mounting"),
                                HasSubstr("footing-ctl setup --worn right_leg"))));
  EXPECT_THAT(Warnings({"leg", "trunk"}, worn),
              ElementsAre(HasSubstr("right_leg"), HasSubstr("trunk")));
  EXPECT_THAT(Warnings({"wrist"}, Hands()), IsEmpty());
  std::vector<DeviceStatus> boards{Good(DeviceRole::kLeftBoard), Good(DeviceRole::kRightBoard)};
  boards[1].tared = true;
  EXPECT_THAT(Warnings({"boards"}, boards),
              ElementsAre(AllOf(HasSubstr("not tared"), HasSubstr("footing-ctl tare"))));
}

TEST(DeviceGate, NamesEveryFaultWithItsRemedy) {
  const auto after = [](auto change) {
    auto devices = Hands();
    change(devices[1]);
    return Problems({}, {"wrist"}, devices);
  };
  EXPECT_THAT(after([](DeviceStatus& d) { d.battery_fraction = 0.19; }),
              ElementsAre(AllOf(HasSubstr("right_hand (00:1f) has 19 % of battery, and 20 %"),
                                HasSubstr("change the batteries"))));
  EXPECT_THAT(after([](DeviceStatus& d) { d.battery_fraction = 0.2; }), IsEmpty());
  EXPECT_THAT(after([](DeviceStatus& d) { d.battery_fraction = -1; }), IsEmpty());  // Unknown.
  EXPECT_THAT(after([](DeviceStatus& d) { d.battery_low = true; }), testing::SizeIs(1));
  EXPECT_THAT(after([](DeviceStatus& d) { d.report_rate_hz = 12; }),
              ElementsAre(HasSubstr("12 times")));
  EXPECT_THAT(after([](DeviceStatus& d) { d.state = DeviceState::kStale; }),
              ElementsAre(HasSubstr("is stale")));
  EXPECT_THAT(after([](DeviceStatus& d) { d.slipped = true; }),
              ElementsAre(HasSubstr("footing-ctl setup")));
  EXPECT_THAT(after([](DeviceStatus& d) { d.state = DeviceState::kLost; }),
              ElementsAre(HasSubstr("is missing")));
}

TEST(DeviceGate, RefusesSimulatedDevicesUnlessTheProtocolAllowsThem) {
  auto devices = Hands();
  devices[0].simulated = true;
  plan::DeviceGate gate;
  EXPECT_THAT(Problems(gate, {"wrist"}, devices), ElementsAre(HasSubstr("is simulated")));
  gate.allow_simulated = true;
  EXPECT_THAT(Problems(gate, {"wrist"}, devices), IsEmpty());
}

}  // namespace
}  // namespace footing::study::gate
