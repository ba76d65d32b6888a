// Which device has which role, and whose samples a rig's features come from.
#include <algorithm>
#include <utility>

#include "daemon/sensor/service/hub.h"

namespace footing::sensor {
namespace {

using stream::DeviceRole;

constexpr std::size_t kMaxRigMembers = 8;  // Of RigFeatureExtractor.

}  // namespace

/// A real device that comes back gets its role back from a simulated one that has it in the
/// meantime, unless it was assigned to that one.
bool Hub::GivesWay(const Device& holder, const Device& device) const {
  return !device.simulated() && holder.simulated() && holder.binding() == device.binding() &&
         !assigned_.contains(holder.identity().serial);
}

Binding Hub::ChooseBinding(const Device& device) const {
  const devices::DeviceIdentity& identity = device.identity();
  const auto assigned = assigned_.find(identity.serial);
  if (assigned != assigned_.end() && RoleFits(device.placement(), assigned->second.role)) {
    return assigned->second;
  }
  std::vector<Binding> taken;
  for (const auto& other : devices_) {
    if (other.get() == &device || !other->attached() || GivesWay(*other, device)) continue;
    taken.push_back(other->binding());
  }
  const auto is_free = [&taken](const Binding& binding) {
    return std::find(taken.begin(), taken.end(), binding) == taken.end();
  };
  // One that comes back keeps its role.
  const Binding& before = device.binding();
  if (before.role != DeviceRole::kUnspecified && RoleFits(device.placement(), before.role) &&
      is_free(before)) {
    return before;
  }
  Binding wish = {identity.wished_rig.empty() ? config_.default_rig : identity.wished_rig,
                  identity.wished_role};
  if (wish.role == DeviceRole::kUnspecified || !RoleFits(device.placement(), wish.role) ||
      !is_free(wish)) {
    wish.role = FirstFreeRole(device.placement(), wish.rig, taken);
  }
  return wish;
}

std::string Hub::WhyOtherRole(const Device& device) const {
  const DeviceRole wished = device.identity().wished_role;
  if (wished == DeviceRole::kUnspecified || wished == device.binding().role) return "";
  const std::string text = std::string(", not ") + stream::Name(wished) + " as it asked: ";
  if (!RoleFits(device.placement(), wished)) {
    return text + "a " + stream::Name(device.kind()) + " cannot be that";
  }
  const bool assigned = assigned_.contains(device.identity().serial);
  return text + (assigned ? ToText(device.binding()) + " is assigned to it" : "that is taken");
}

void Hub::Bind(Device& device) {
  Rebind(device, ChooseBinding(device));
  if (device.binding().role == DeviceRole::kUnspecified) return;
  for (const auto& other : devices_) {
    if (other.get() != &device && other->attached() && GivesWay(*other, device)) {
      Rebind(*other, ChooseBinding(*other));
    }
  }
}

void Hub::Rebind(Device& device, const Binding& binding) {
  device.set_binding(binding);
  status_due_ = true;
  ApplySetup(device);
  RebuildRigs();
}

/// Rigs whose members stayed as they are keep their features. A lost device stays a member of its
/// rig until its role goes to another.
void Hub::RebuildRigs() {
  std::map<std::string, std::vector<features::Member>> members;
  for (const auto& device : devices_) {
    const Binding& binding = device->binding();
    if (device->placement() != decode::Placement::kOnBody ||
        binding.role == DeviceRole::kUnspecified) {
      continue;
    }
    auto& rig = members[binding.rig];
    const auto holder = std::find_if(rig.begin(), rig.end(), [&binding](const auto& member) {
      return member.role == binding.role;
    });
    if (holder != rig.end()) {
      if (device->attached()) holder->device = device->number();
    } else if (rig.size() < kMaxRigMembers) {
      rig.push_back({device->number(), binding.role});
    }
  }
  std::erase_if(rigs_, [&members](const auto& rig) { return !members.contains(rig.first); });
  for (auto& [name, wanted] : members) {
    Rig& rig = rigs_[name];
    const bool same = std::equal(
        rig.members.begin(), rig.members.end(), wanted.begin(), wanted.end(),
        [](const auto& a, const auto& b) { return a.device == b.device && a.role == b.role; });
    if (same) continue;
    rig.members = wanted;
    rig.extractor = std::make_unique<features::RigFeatureExtractor>(name, wanted);
  }
}

Result<void> Hub::AssignRole(const std::string& serial, const Binding& binding) {
  if (const auto rig = CheckRig(binding.rig); !rig) {
    return UsageError("assign_role: " + rig.error().message);
  }
  Device* const found = WithSerial(serial);
  if (found == nullptr) return NoDevice("no device with serial " + serial + " was seen");
  Device& device = *found;
  if (!RoleFits(device.placement(), binding.role)) {
    return UsageError(std::string("a ") + stream::Name(device.kind()) + " cannot be " +
                      stream::Name(binding.role));
  }
  const Binding before = device.binding();
  for (const auto& other : devices_) {
    if (other.get() == &device || other->binding() != binding) continue;
    KeepRole(other->identity().serial, before);
    Rebind(*other, before);
  }
  KeepRole(serial, binding);
  Rebind(device, binding);
  return {};
}

}  // namespace footing::sensor
