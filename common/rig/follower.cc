#include "common/rig/follower.h"

#include <algorithm>

#include "common/base/units.h"
#include "common/board/layout.h"
#include "common/stream/user_interface.h"

namespace footing::rig {

using stream::DeviceRole;
using stream::DeviceState;
using stream::DeviceStatus;

bool LastHeard::IsLive(std::int64_t now_ns, double timeout_s) const {
  return ever && NanosecondsToSeconds(now_ns - at_ns) <= timeout_s;
}

Changes Follower::Take(const Tick& tick) {
  const Changes changes{tick.epoch != epoch_, tick.devices.has_value(), tick.setup.has_value()};
  if (changes.restarted) {
    epoch_ = tick.epoch;
    rig_ = wanted_rig_;
    devices_.clear();
    setup_.clear();
  }
  if (changes.devices) devices_ = *tick.devices;
  if (changes.setup) setup_ = *tick.setup;
  for (const DeviceStatus& device : devices_) {
    if (device.state != DeviceState::kLost) Follows(device.rig, device.role);
  }
  return changes;
}

bool Follower::Follows(const std::string& rig, DeviceRole role) {
  if (rig_.empty() && (roles_ & stream::RoleBit(role)) != 0) rig_ = rig;
  return !rig_.empty() && rig == rig_;
}

const stream::RigFeatures* Follower::FeaturesIn(const Tick& tick) {
  for (const stream::RigFeatures& rig : tick.features) {
    for (const stream::DeviceFeatures& device : rig.devices) {
      // Features go on for a lost device, until another one has its role.
      const DeviceStatus* status = Find(device.device);
      if (status == nullptr || status->state != DeviceState::kLost) Follows(rig.rig, device.role);
    }
    if (!rig_.empty() && rig.rig == rig_) return &rig;
  }
  return nullptr;
}

void Follower::GoTo(const std::string& rig, std::uint32_t roles) {
  rig_ = rig;
  roles_ = roles;
}

const DeviceStatus* Follower::Find(std::uint32_t device) const {
  const auto found =
      std::find_if(devices_.begin(), devices_.end(),
                   [device](const DeviceStatus& one) { return one.device == device; });
  return found == devices_.end() ? nullptr : &*found;
}

DeviceRole Follower::RoleOf(std::uint32_t device) const {
  const DeviceStatus* found = Find(device);
  const bool used =
      found != nullptr && IsOwn(*found) && (roles_ & stream::RoleBit(found->role)) != 0;
  return used ? found->role : DeviceRole::kUnspecified;
}

const DeviceStatus* Follower::With(DeviceRole role) const {
  const DeviceStatus* found = nullptr;
  for (const DeviceStatus& device : devices_) {
    if (!IsOwn(device) || device.role != role) continue;
    if (found == nullptr || found->state == DeviceState::kLost) found = &device;
  }
  return found;
}

std::uint32_t Follower::MountedRoles() const {
  std::uint32_t roles = 0;
  for (const DeviceStatus& device : devices_) {
    if (IsOwn(device) && device.mounted) roles |= stream::RoleBit(device.role);
  }
  return roles;
}

stream::BoardLayout Follower::Layout() const {
  const auto found = std::find_if(setup_.begin(), setup_.end(),
                                  [this](const auto& setup) { return setup.rig == rig_; });
  return board::LayoutOr(found == setup_.end() ? stream::BoardLayout() : found->layout);
}

}  // namespace footing::rig
