#include "common/stream/interface_roles.h"

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

}  // namespace footing::stream
