#include "clients/study/plan/device_gate.h"

#include <cmath>

#include "common/base/text.h"
#include "common/stream/roles.h"

namespace footing::study::gate {
namespace {

using stream::DeviceRole;
using stream::DeviceStatus;

const DeviceStatus* WithRole(DeviceRole role, const std::vector<DeviceStatus>& devices) {
  const DeviceStatus* found = nullptr;
  for (const DeviceStatus& device : devices) {
    if (device.role != role || device.state == stream::DeviceState::kLost) continue;
    // The live one of two with one role counts.
    if (found == nullptr || device.state == stream::DeviceState::kLive) found = &device;
  }
  return found;
}

/// Device of a role that the interface needs; null: none. The joystick is in the hand whose device
/// has a stick.
const DeviceStatus* DeviceOf(DeviceRole role, const std::string& interface,
                             const std::vector<DeviceStatus>& devices) {
  const DeviceStatus* device = WithRole(role, devices);
  if (interface != "joystick" || (device != nullptr && stream::HasStick(*device))) return device;
  const DeviceStatus* other = WithRole(DeviceRole::kLeftHand, devices);
  return device == nullptr || (other != nullptr && stream::HasStick(*other)) ? other : device;
}

/// A head's controller is worn as its frame is, and hands need no mounting (docs/interfaces.md).
bool NeedsMounting(DeviceRole role) {
  return role == DeviceRole::kLeftLeg || role == DeviceRole::kRightLeg ||
         role == DeviceRole::kTrunk;
}

bool IsBoard(DeviceRole role) {
  return role == DeviceRole::kLeftBoard || role == DeviceRole::kRightBoard;
}

std::string Percent(double share) { return text::Fixed(std::floor(100 * share), 0) + " %"; }

void Check(const plan::DeviceGate& gate, const DeviceStatus& device,
           std::vector<std::string>& problems) {
  const std::string name = std::string(stream::Name(device.role)) + " (" + device.serial + ")";
  if (device.simulated && !gate.allow_simulated) {
    problems.push_back(name +
                       " is simulated; connect a real device, or set devices.allow_simulated");
  }
  if (device.state != stream::DeviceState::kLive) {
    problems.push_back(name + " is " + stream::Name(device.state) + "; press one of its buttons");
    return;
  }
  if (device.report_rate_hz < gate.least_rate_hz) {
    problems.push_back(name + " reports " + text::Fixed(device.report_rate_hz, 0) +
                       " times a second, and " + text::Fixed(gate.least_rate_hz, 0) +
                       " are needed; move it closer to the computer");
  }
  const bool known = device.battery_fraction >= 0;
  if (device.battery_low || (known && device.battery_fraction < gate.least_battery)) {
    problems.push_back(
        name + " has " + (known ? Percent(device.battery_fraction) + " of" : "a low") +
        " battery, and " + Percent(gate.least_battery) + " is needed; change the batteries");
  }
  if (device.slipped || device.moved) {
    problems.push_back(name + " has moved since its setup; run footing-ctl setup");
  }
}

}  // namespace

bool AnySimulated(const plan::Played& played, const std::vector<DeviceStatus>& devices) {
  for (const DeviceRole role : plan::RolesOf(played)) {
    const DeviceStatus* device = DeviceOf(role, played.interface, devices);
    if (device != nullptr && device->simulated) return true;
  }
  return false;
}

std::vector<std::string> Problems(const plan::DeviceGate& gate, const plan::Played& played,
                                  const std::vector<DeviceStatus>& devices) {
  std::vector<std::string> problems;
  for (const DeviceRole role : plan::RolesOf(played)) {
    const DeviceStatus* device = DeviceOf(role, played.interface, devices);
    if (device == nullptr) {
      problems.push_back(std::string(stream::Name(role)) + " is missing, and the interface " +
                         played.interface +
                         " needs it; connect it, or give it the role: footing-ctl setup");
      continue;
    }
    Check(gate, *device, problems);
    if (played.interface == "joystick" && !stream::HasStick(*device)) {
      problems.push_back(std::string(stream::Name(device->role)) + " (" + device->serial +
                         ") has no Nunchuk; plug one into it, or use a Joy-Con");
    }
  }
  return problems;
}

std::vector<std::string> Warnings(const plan::Played& played,
                                  const std::vector<DeviceStatus>& devices) {
  std::vector<std::string> warnings;
  for (const DeviceRole role : plan::RolesOf(played)) {
    const DeviceStatus* device = DeviceOf(role, played.interface, devices);
    if (device == nullptr) continue;
    const std::string name = std::string(stream::Name(role)) + " (" + device->serial + ")";
    if (NeedsMounting(role) && !device->mounted) {
      warnings.push_back(name +
                         " is worn without a mounting, so its features are less exact; run "
                         "footing-ctl setup --worn " +
                         stream::Name(role));
    }
    if (IsBoard(role) && !device->tared) {
      warnings.push_back(name + " is not tared; run footing-ctl tare with nobody on it");
    }
  }
  return warnings;
}

}  // namespace footing::study::gate
