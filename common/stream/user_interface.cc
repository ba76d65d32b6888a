#include "common/stream/user_interface.h"

#include <algorithm>
#include <vector>

#include "common/stream/leg_turn.h"

namespace footing::stream {

TurnSource LegTurnSourceNamed(const std::string& name) {
  for (const auto source : kLegTurnSources) {
    if (name == Name(source)) return source;
  }
  return TurnSource::kUnspecified;
}

std::uint32_t DrivingRoles(UserInterface interface) {
  switch (interface) {
    case UserInterface::kUnspecified:
      return 0;
    case UserInterface::kWrist:
    case UserInterface::kArm:
    case UserInterface::kJoystick:
      return RoleBit(DeviceRole::kLeftHand) | RoleBit(DeviceRole::kRightHand);
    case UserInterface::kLeg:
      return RoleBit(DeviceRole::kLeftLeg) | RoleBit(DeviceRole::kRightLeg);
    case UserInterface::kBoards:
      return RoleBit(DeviceRole::kLeftBoard) | RoleBit(DeviceRole::kRightBoard);
  }
  return 0;
}

std::string RoleNames(std::uint32_t roles) {
  std::string names;
  for (const DeviceRole role : kDeviceRoles) {
    if ((roles & RoleBit(role)) == 0) continue;
    names += (names.empty() ? "" : ", ") + std::string(Name(role));
  }
  return names;
}

std::string DevicesText(UserInterface interface, std::uint32_t roles) {
  std::vector<std::string> names;
  for (const DeviceRole role : kDeviceRoles) {
    if ((roles & RoleBit(role)) == 0) continue;
    std::string& name = names.emplace_back("the " + std::string(Name(role)));
    std::replace(name.begin(), name.end(), '_', ' ');
  }
  if (interface == UserInterface::kJoystick) {
    return names.size() == 1 ? "the joystick in " + names.front() : "the joystick";
  }
  std::string list;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0) list += i + 1 == names.size() ? " and " : ", ";
    list += names[i];
  }
  return list;
}

}  // namespace footing::stream
