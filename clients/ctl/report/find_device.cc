#include "clients/ctl/report/find_device.h"

#include <algorithm>
#include <cctype>

namespace footing::ctl::display {
namespace {

using stream::DeviceStatus;

std::string Lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

std::string WhatThereIs(const std::vector<DeviceStatus>& devices) {
  if (devices.empty()) return "footingd has no device: pair one with footing-ctl pair";
  std::string text = "there are:";
  for (const DeviceStatus& device : devices) {
    text += " " + std::to_string(device.device) + " = " + device.serial;
    if (device.role != stream::DeviceRole::kUnspecified) {
      text += " = " + device.rig + "/" + stream::Name(device.role);
    }
    text += device.state == stream::DeviceState::kLost ? " (lost)," : ",";
  }
  text.pop_back();
  return text;
}

bool Answers(const DeviceStatus& device, const std::string& name) {
  if (Lower(device.serial) == name || std::to_string(device.device) == name) return true;
  if (device.role == stream::DeviceRole::kUnspecified) return false;
  if (device.state == stream::DeviceState::kLost) return false;
  const std::string role = stream::Name(device.role);
  return name == role || name == Lower(device.rig) + "/" + role;
}

}  // namespace

Result<DeviceStatus> FindDevice(const std::vector<DeviceStatus>& devices, const std::string& name) {
  const std::string wanted = Lower(name);
  std::vector<DeviceStatus> found;
  for (const DeviceStatus& device : devices) {
    if (Answers(device, wanted)) found.push_back(device);
  }
  if (found.size() == 1) return found.front();
  if (found.empty()) return NoDevice("no device " + name + "; " + WhatThereIs(devices));
  return NoDevice("more than one device is " + name + "; " + WhatThereIs(found));
}

Boards BoardsOf(const std::vector<DeviceStatus>& devices) {
  Boards boards;
  for (const DeviceStatus& device : devices) {
    if (device.kind != stream::DeviceKind::kBalanceBoard) continue;
    if (device.state != stream::DeviceState::kLost) {
      boards.there.push_back(device);
      continue;
    }
    const bool needed =
        device.role != stream::DeviceRole::kUnspecified &&
        std::none_of(devices.begin(), devices.end(), [&](const DeviceStatus& other) {
          return other.state != stream::DeviceState::kLost && other.rig == device.rig &&
                 other.role == device.role;
        });
    if (needed) boards.lost.push_back(device);
  }
  return boards;
}

std::vector<DeviceStatus> Reassigned(const std::vector<DeviceStatus>& before,
                                     const std::vector<DeviceStatus>& now) {
  std::vector<DeviceStatus> changed;
  for (const DeviceStatus& device : now) {
    const bool known = std::any_of(before.begin(), before.end(), [&](const DeviceStatus& other) {
      return other.device == device.device && other.serial == device.serial &&
             (other.rig != device.rig || other.role != device.role);
    });
    if (known) changed.push_back(device);
  }
  return changed;
}

Result<std::pair<std::string, stream::DeviceRole>> ParseRigRole(const std::string& text) {
  const std::size_t slash = text.rfind('/');  // A rig's name may have one.
  const std::string rig = slash == std::string::npos ? "" : text.substr(0, slash);
  const std::string name = slash == std::string::npos ? text : text.substr(slash + 1);
  const stream::DeviceRole role = stream::RoleNamed(name);
  if (role == stream::DeviceRole::kUnspecified || (slash != std::string::npos && rig.empty())) {
    return UsageError(
        text + " is not a RIG/ROLE such as main/left_hand; roles are: " + stream::RoleNames());
  }
  return std::make_pair(rig, role);
}

}  // namespace footing::ctl::display
