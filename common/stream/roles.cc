#include "common/stream/roles.h"

namespace footing::stream {

std::vector<DeviceRole> RolesOf(UserInterface interface, TurnSource turn_by) {
  switch (interface) {
    case UserInterface::kUnspecified:
      return {};
    case UserInterface::kWrist:
    case UserInterface::kArm:
      return {DeviceRole::kLeftHand, DeviceRole::kRightHand};
    case UserInterface::kLeg:
      if (turn_by == TurnSource::kFeet) return {DeviceRole::kLeftLeg, DeviceRole::kRightLeg};
      return {DeviceRole::kLeftLeg, DeviceRole::kRightLeg,
              turn_by == TurnSource::kTrunk ? DeviceRole::kTrunk : DeviceRole::kHead};
    case UserInterface::kJoystick:
      return {DeviceRole::kRightHand};
    case UserInterface::kBoards:
      return {DeviceRole::kLeftBoard, DeviceRole::kRightBoard};
  }
  return {};
}

std::uint32_t LedsOf(DeviceRole role) {
  switch (role) {
    case DeviceRole::kLeftHand:
      return 0b0001;
    case DeviceRole::kRightHand:
      return 0b0010;
    case DeviceRole::kLeftLeg:
      return 0b0100;
    case DeviceRole::kRightLeg:
      return 0b1000;
    case DeviceRole::kHead:
      return 0b1001;
    case DeviceRole::kTrunk:
      return 0b0101;
    case DeviceRole::kLeftBoard:
      return 0b0001;
    case DeviceRole::kEditor:
      return 0b0110;
    case DeviceRole::kLeftUpperArm:
      return 0b0011;
    case DeviceRole::kRightUpperArm:
      return 0b1010;
    case DeviceRole::kLeftForearm:
      return 0b0111;
    case DeviceRole::kRightForearm:
      return 0b1110;
    case DeviceRole::kPelvis:
      return 0b1101;
    case DeviceRole::kLeftThigh:
      return 0b1011;
    case DeviceRole::kRightThigh:
      return 0b1100;
    case DeviceRole::kRightBoard:
    case DeviceRole::kUnspecified:
      return 0;
  }
  return 0;
}

bool HasStick(const DeviceStatus& device) {
  return device.extension == Extension::kNunchuk ||
         device.extension == Extension::kMotionPlusNunchuk ||
         device.kind == DeviceKind::kJoyConLeft || device.kind == DeviceKind::kJoyConRight ||
         device.kind == DeviceKind::kSwitchProController;
}

}  // namespace footing::stream
