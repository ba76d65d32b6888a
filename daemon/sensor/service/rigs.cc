#include "daemon/sensor/service/rigs.h"

#include <algorithm>
#include <utility>

namespace footing::sensor {
namespace {

using decode::Placement;
using stream::DeviceRole;

constexpr std::size_t kMaxRigMembers = 8;  // Limit of RigFeatureExtractor.

}  // namespace

Device* DeviceTable::Find(devices::DeviceHandle handle) const {
  for (const auto& device : devices_) {
    if (device->Owns(handle)) return device.get();
  }
  return nullptr;
}

Device* DeviceTable::Numbered(std::uint32_t number) const {
  for (const auto& device : devices_) {
    if (device->number() == number) return device.get();
  }
  return nullptr;
}

Device* DeviceTable::WithSerial(const std::string& serial) const {
  for (const auto& device : devices_) {
    if (device->identity().serial == serial) return device.get();
  }
  return nullptr;
}

Result<Device*> DeviceTable::Attached(std::uint32_t number) const {
  Device* found = Numbered(number);
  if (found == nullptr || !found->attached()) {
    return NoDevice("device " + std::to_string(number) + " is not attached");
  }
  return found;
}

Result<Device*> DeviceTable::Attached(const std::string& serial) const {
  Device* found = WithSerial(serial);
  if (found == nullptr) return NoDevice("no device with serial " + serial + " was seen");
  if (!found->attached()) return NoDevice("device " + serial + " is not attached; switch it on");
  return found;
}

Device* DeviceTable::Add(bool simulated, const DeviceOptions& options, const Drop& drop) {
  if (devices_.size() >= kMaxDevices && !FreePlaceFor(simulated, drop)) return nullptr;
  devices_.push_back(std::make_unique<Device>(++last_number_, options));
  return devices_.back().get();
}

bool DeviceTable::FreePlaceFor(bool simulated, const Drop& drop) {
  const auto lost = std::find_if(devices_.begin(), devices_.end(),
                                 [](const auto& device) { return !device->attached(); });
  if (lost != devices_.end()) {
    devices_.erase(lost);
    return true;
  }
  if (simulated) return false;
  const auto newest = std::find_if(devices_.rbegin(), devices_.rend(),
                                   [](const auto& device) { return device->simulated(); });
  if (newest == devices_.rend()) return false;
  drop(**newest, "there are " + std::to_string(kMaxDevices) +
                     " devices already, and a real device takes its place");
  devices_.erase(std::next(newest).base());
  return true;
}

std::set<std::string> DeviceTable::RigsWithBoards() const {
  std::set<std::string> rigs;
  for (const auto& device : devices_) {
    if (device->placement() == Placement::kUnderFeet) rigs.insert(device->binding().rig);
  }
  return rigs;
}

std::size_t DeviceTable::AttachedBoards(const std::string& rig) const {
  return static_cast<std::size_t>(
      std::count_if(devices_.begin(), devices_.end(), [&rig](const auto& device) {
        return device->attached() && device->placement() == Placement::kUnderFeet &&
               device->binding().rig == rig;
      }));
}

RoleAssignment::RoleAssignment(const std::map<std::string, std::string>& configured,
                               const setup::Roles& stored,
                               const std::function<void(const LogLine&)>& log) {
  for (const auto& [serial, text] : configured) {
    if (auto binding = ParseBinding(text)) assigned_[serial] = std::move(binding).value();
  }
  for (const auto& [serial, text] : stored) {
    auto binding = ParseBinding(text);
    if (!binding) {
      log({"the stored role of " + serial + " is ignored: " + binding.error().message, serial,
           true});
      continue;
    }
    const auto earlier = assigned_.find(serial);
    if (earlier != assigned_.end() && earlier->second != *binding) {
      log({serial + " is " + text + " by the last command, no longer " + configured.at(serial) +
               " as in the config",
           serial});
    }
    assigned_[serial] = std::move(binding).value();
  }
}

bool RoleAssignment::GivesWay(const Device& holder, const Device& device) const {
  return !device.simulated() && holder.simulated() && holder.binding() == device.binding() &&
         !assigned_.contains(holder.identity().serial);
}

Binding RoleAssignment::Choose(const Device& device, const DeviceTable& devices,
                               const std::string& default_rig) const {
  const devices::DeviceIdentity& identity = device.identity();
  const auto assigned = assigned_.find(identity.serial);
  if (assigned != assigned_.end() && RoleFits(device.placement(), assigned->second.role)) {
    return assigned->second;
  }
  std::vector<Binding> taken;
  for (const auto& other : devices) {
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
  Binding wish = {
      identity.wished_rig.empty() ? default_rig : identity.wished_rig,
      identity.wished_role == DeviceRole::kUnspecified ? device.own_role() : identity.wished_role};
  if (wish.role == DeviceRole::kUnspecified || !RoleFits(device.placement(), wish.role) ||
      !is_free(wish)) {
    wish.role = FirstFreeRole(device.placement(), wish.rig, taken);
  }
  return wish;
}

std::string RoleAssignment::WhyOther(const Device& device) const {
  const DeviceRole wished = device.identity().wished_role;
  if (wished == DeviceRole::kUnspecified || wished == device.binding().role) return "";
  const std::string text = std::string(", not ") + stream::Name(wished) + " as it asked: ";
  if (!RoleFits(device.placement(), wished)) {
    return text + "a " + stream::Name(device.kind()) + " cannot be that";
  }
  const bool assigned = assigned_.contains(device.identity().serial);
  return text + (assigned ? ToText(device.binding()) + " is assigned to it" : "that is taken");
}

void RigTable::Rebuild(const DeviceTable& devices) {
  std::map<std::string, std::vector<features::Member>> members;
  for (const auto& device : devices) {
    const Binding& binding = device->binding();
    const bool on_body = device->placement() == decode::Placement::kOnBody ||
                         device->placement() == decode::Placement::kByChoice;
    if (!on_body || binding.role == DeviceRole::kUnspecified) continue;
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
    rig.extractor = std::make_unique<features::RigFeatureExtractor>(name, wanted, config_);
  }
}

void RigTable::Restart(const std::string& rig) {
  if (const auto found = rigs_.find(rig); found != rigs_.end()) {
    found->second.extractor =
        std::make_unique<features::RigFeatureExtractor>(rig, found->second.members, config_);
  }
}

void RigTable::Add(const std::string& rig, const stream::MotionSample& sample,
                   std::int64_t decoded_ns) {
  const auto found = rigs_.find(rig);
  if (found == rigs_.end()) return;
  found->second.extractor->AddSample(sample);
  found->second.decoded_ns = decoded_ns;
}

std::vector<stream::RigFeatures> RigTable::Compute(
    std::int64_t now_ns, const DeviceTable& devices,
    const std::function<std::int64_t()>& computed_ns) {
  std::vector<stream::RigFeatures> all;
  for (auto& [name, rig] : rigs_) {
    stream::RigFeatures& features = all.emplace_back(rig.extractor->Compute(now_ns));
    features.decoded_ns = rig.decoded_ns;
    for (stream::DeviceFeatures& one : features.devices) {
      const Device* device = devices.Numbered(one.device);
      one.simulated = device != nullptr && device->simulated();
    }
    features.computed_ns = computed_ns();
  }
  return all;
}

}  // namespace footing::sensor
