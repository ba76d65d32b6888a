#include "clients/ctl/display/find_device.h"

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
