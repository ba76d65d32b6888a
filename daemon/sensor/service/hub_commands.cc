// Commands to one device, and the leases of motors.
#include <algorithm>

#include "common/base/units.h"
#include "daemon/sensor/service/hub.h"

namespace footing::sensor {
namespace {

constexpr double kDefaultLeaseS = 1;
constexpr double kMaxLeaseS = 10;

}  // namespace

void Hub::EndLeases(std::int64_t now_ns) {
  for (auto it = leases_.begin(); it != leases_.end();) {
    if (now_ns < it->second.until_ns) {
      ++it;
      continue;
    }
    if (Device* device = Numbered(it->first)) device->outbox().SetRumble(false);
    it = leases_.erase(it);
  }
}

Result<Device*> Hub::Attached(std::uint32_t number) {
  Device* found = Numbered(number);
  if (found == nullptr || !found->attached()) {
    return NoDevice("device " + std::to_string(number) + " is not attached");
  }
  return found;
}

Result<void> Hub::SetRumble(std::uint64_t session, std::uint32_t device, bool on, double lease_s) {
  const auto attached = Attached(device);
  if (!attached) return attached.error();
  Device* const found = *attached;
  found->outbox().SetRumble(on);
  status_due_ = true;
  if (!on) {
    leases_.erase(device);
  } else {
    const double granted_s = lease_s > 0 ? std::min(lease_s, kMaxLeaseS) : kDefaultLeaseS;
    leases_[device] = {session, ports_.now_ns() + SecondsToNanoseconds(granted_s)};
  }
  Flush(*found);
  return {};
}

Result<void> Hub::SetLeds(std::uint32_t device, std::uint8_t leds) {
  const auto found = Attached(device);
  if (!found) return found.error();
  (*found)->SetLeds(leds);
  status_due_ = true;
  Flush(**found);
  return {};
}

Result<void> Hub::SetSphere(std::uint32_t device, std::uint32_t rgb) {
  const auto found = Attached(device);
  if (!found) return found.error();
  if (!(*found)->SetSphere(rgb)) {
    return UsageError("device " + std::to_string(device) + " has no sphere");
  }
  status_due_ = true;
  Flush(**found);
  return {};
}

Result<void> Hub::SetCamera(std::uint32_t device, bool on) {
  const auto found = Attached(device);
  if (!found) return found.error();
  if (!(*found)->SetCamera(on)) {
    return UsageError("device " + std::to_string(device) + " has no camera");
  }
  return {};
}

Result<void> Hub::RequestDeviceStatus(std::uint32_t device) {
  const auto found = Attached(device);
  if (!found) return found.error();
  if (!(*found)->RequestStatus(ports_.now_ns())) {
    return UsageError("device " + std::to_string(device) +
                      " was asked less than a second ago, or has no status report");
  }
  return {};
}

void Hub::EndSession(std::uint64_t session) {
  const auto is_its = [session](const auto& one) { return one.second.session == session; };
  if (std::erase_if(prompts_, is_its) > 0) content_.has_setup = true;
  for (auto it = leases_.begin(); it != leases_.end();) {
    if (it->second.session != session) {
      ++it;
      continue;
    }
    if (Device* device = Numbered(it->first)) device->outbox().SetRumble(false);
    it = leases_.erase(it);
  }
}

void Hub::StopMotors() {
  for (const auto& device : devices_) {
    if (!device->attached() || !device->outbox().rumble()) continue;
    device->outbox().SetRumble(false);
    ports_.send(device->handle(), device->MotorOff());
  }
}

}  // namespace footing::sensor
