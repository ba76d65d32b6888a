#include "daemon/sensor/service/hub.h"

#include <algorithm>
#include <utility>

#include "daemon/sensor/reports/move_report.h"

namespace footing::sensor {
namespace {

using stream::DeviceKind;
using stream::DeviceRole;

constexpr std::int64_t kStatusIntervalNs = 200'000'000;
constexpr double kDefaultLeaseS = 1;
constexpr double kMaxLeaseS = 10;
constexpr std::size_t kMaxRigMembers = 8;  // Of RigFeatureExtractor.

}  // namespace

Hub::Hub(const Config& config, Ports ports)
    : config_(config), ports_(std::move(ports)), book_(ports_.shelf) {
  for (const auto& [serial, text] : config_.roles) {
    if (auto binding = ParseBinding(text)) assigned_[serial] = std::move(binding).value();
  }
  for (const auto& [serial, text] : book_.roles()) {
    auto binding = ParseBinding(text);
    if (!binding) continue;
    const auto configured = assigned_.find(serial);
    if (configured != assigned_.end() && configured->second != *binding) {
      ports_.log(serial + " is " + text + " by the last command, no longer " +
                 config_.roles.at(serial) + " as in the config");
    }
    assigned_[serial] = std::move(binding).value();
  }
}

Device* Hub::Find(devices::DeviceHandle handle) {
  for (const auto& device : devices_) {
    if (device->Owns(handle)) return device.get();
  }
  return nullptr;
}

Device* Hub::WithSerial(const std::string& serial) {
  for (const auto& device : devices_) {
    if (device->identity().serial == serial) return device.get();
  }
  return nullptr;
}

Device* Hub::Numbered(std::uint32_t number) {
  for (const auto& device : devices_) {
    if (device->number() == number) return device.get();
  }
  return nullptr;
}

/// A new Device; null when all are attached and there is no room.
Device* Hub::MakeRoom() {
  if (devices_.size() >= kMaxDevices) {
    const auto lost = std::find_if(devices_.begin(), devices_.end(),
                                   [](const auto& device) { return !device->attached(); });
    if (lost == devices_.end()) return nullptr;
    devices_.erase(lost);
  }
  DeviceOptions options;
  options.plate = config_.plate;
  options.local_gravity_mps2 = config_.local_gravity_mps2;
  options.handshake.motion_plus = config_.motion_plus;
  options.handshake.camera = config_.camera;
  options.handshake.status_interval_s = config_.status_interval_s;
  devices_.push_back(std::make_unique<Device>(++last_number_, options));
  return devices_.back().get();
}

void Hub::OnAttach(devices::DeviceHandle handle, const devices::DeviceIdentity& identity) {
  Device* device = WithSerial(identity.serial);
  if (device != nullptr && device->attached() && !device->simulated() && identity.simulated) {
    ports_.log("a simulated device with the serial of the real device " + identity.serial +
               " is ignored");
    return;
  }
  if (device != nullptr && device->attached() && device->kind() == DeviceKind::kPsMove &&
      device->identity().bus != identity.bus) {
    device->AttachSecond(handle, identity);
    status_due_ = true;
    ports_.log("device " + std::to_string(device->number()) + " (" + identity.serial +
               ") is on a second link: " + identity.place);
    Flush(*device);
    return;
  }
  if (device == nullptr) device = MakeRoom();
  if (device == nullptr) {
    ports_.log("more than " + std::to_string(kMaxDevices) + " devices: " + identity.serial +
               " is ignored");
    return;
  }
  Device::Stored stored;
  if (ports_.load_calibration) stored = ports_.load_calibration(identity.serial);
  device->Attach(handle, identity, stored);
  Bind(*device);
  ports_.log(std::string(identity.simulated ? "simulated " : "") + stream::Name(device->kind()) +
             " " + identity.serial + " attached as device " + std::to_string(device->number()) +
             ", " + device->binding().rig + "/" + stream::Name(device->binding().role) + ": " +
             identity.place);
  device->Advance(ports_.now_ns());
  Flush(*device);
}

void Hub::OnDetach(devices::DeviceHandle handle, const std::string& reason) {
  Device* device = Find(handle);
  if (device == nullptr) return;
  device->Detach(handle, reason);
  status_due_ = true;
  if (device->attached()) return;  // Its other link is still there.
  leases_.erase(device->number());
  ports_.log("device " + std::to_string(device->number()) + " (" + device->identity().serial +
             ") lost: " + reason);
}

Binding Hub::ChooseBinding(const Device& device) const {
  const devices::DeviceIdentity& identity = device.identity();
  const auto assigned = assigned_.find(identity.serial);
  if (assigned != assigned_.end() && RoleFits(device.kind(), assigned->second.role)) {
    return assigned->second;
  }
  std::vector<Binding> taken;
  for (const auto& other : devices_) {
    if (other.get() != &device && other->attached()) taken.push_back(other->binding());
  }
  const auto is_free = [&taken](const Binding& binding) {
    return std::find(taken.begin(), taken.end(), binding) == taken.end();
  };
  // One that comes back keeps its role.
  const Binding& before = device.binding();
  if (before.role != DeviceRole::kUnspecified && RoleFits(device.kind(), before.role) &&
      is_free(before)) {
    return before;
  }
  Binding wish = {identity.wished_rig.empty() ? config_.default_rig : identity.wished_rig,
                  identity.wished_role};
  if (wish.role == DeviceRole::kUnspecified || !RoleFits(device.kind(), wish.role) ||
      !is_free(wish)) {
    wish.role = FirstFreeRole(device.kind(), wish.rig, taken);
  }
  return wish;
}

void Hub::Bind(Device& device) { Rebind(device, ChooseBinding(device)); }

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
    if (device->kind() == DeviceKind::kBalanceBoard || binding.role == DeviceRole::kUnspecified) {
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

void Hub::TakeRaw(const Device& device, std::int64_t at_ns, std::span<const std::uint8_t> bytes,
                  bool to_device, std::int64_t true_ns) {
  if (content_.raw.size() >= kMaxSamplesPerTick || bytes.size() > 64) return;
  stream::RawReport raw;
  raw.device = device.number();
  raw.received_ns = at_ns;
  raw.report.assign(bytes.begin(), bytes.end());
  raw.to_device = to_device;
  raw.simulated = device.simulated();
  raw.true_ns = true_ns;
  content_.raw.push_back(std::move(raw));
}

void Hub::AddToRig(const Device& device, const stream::MotionSample& sample) {
  const auto rig = rigs_.find(device.binding().rig);
  if (rig == rigs_.end()) return;
  rig->second.extractor->AddSample(sample);
  rig->second.decoded_ns = ports_.now_ns();
}

void Hub::OnReport(devices::DeviceHandle handle, const devices::IncomingReport& report) {
  Device* device = Find(handle);
  if (device == nullptr) return;
  TakeRaw(*device, report.received_ns, report.bytes, false, report.true_ns);
  const DeviceKind kind = device->kind();
  const std::size_t before = content_.motion.size();
  device->Take(handle, report, content_);
  if (const auto fresh = device->TakeFreshCalibration(); fresh && ports_.save_calibration) {
    ports_.save_calibration(device->identity().serial, *fresh);
  }
  if (device->kind() != kind) Bind(*device);
  for (std::size_t i = before; i < content_.motion.size(); ++i) {
    AddToRig(*device, device->worn().Take(content_.motion[i]));
  }
  Flush(*device);
}

/// Writes the device's next report if one is due.
void Hub::Flush(Device& device) {
  if (!device.attached()) return;
  const std::int64_t now_ns = ports_.now_ns();
  if (ports_.request_feature) {
    if (const auto feature = device.NextFeature(now_ns)) {
      ports_.request_feature(feature->handle, feature->id, feature->size);
    }
  }
  const auto report = device.NextOutput(now_ns);
  if (!report) return;
  ports_.send(device.handle(), *report);
  TakeRaw(device, now_ns, *report, true, 0);
}

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

void Hub::PublishStatus(std::int64_t now_ns) {
  std::vector<stream::DeviceState> states;
  std::vector<stream::DeviceStatus> status;
  for (const auto& device : devices_) {
    status.push_back(device->Status(now_ns, config_.stale_after_s));
    AddSetupTo(status.back());
    states.push_back(status.back().state);
  }
  if (!status_due_ && states == last_states_ && now_ns - status_ns_ < kStatusIntervalNs) return;
  status_due_ = false;
  status_ns_ = now_ns;
  last_states_ = std::move(states);
  content_.has_status = true;
  content_.status = std::move(status);
}

TickContent Hub::Tick(std::int64_t now_ns) {
  EndLeases(now_ns);
  for (const auto& device : devices_) {
    device->Advance(now_ns);
    Flush(*device);
  }
  for (auto& [name, rig] : rigs_) {
    stream::RigFeatures features = rig.extractor->Compute(now_ns);
    features.decoded_ns = rig.decoded_ns;
    for (stream::DeviceFeatures& one : features.devices) {
      const Device* device = Numbered(one.device);
      one.simulated = device != nullptr && device->simulated();
    }
    features.computed_ns = ports_.now_ns();
    content_.features.push_back(std::move(features));
  }
  if (book_.revision() != published_revision_) {
    published_revision_ = book_.revision();
    content_.has_setup = true;
    ApplySetupToAll();
  }
  if (std::set<std::string> rigs = RigsWithBoards(); rigs != published_board_rigs_) {
    published_board_rigs_ = std::move(rigs);
    content_.has_setup = true;
  }
  if (content_.has_setup) content_.setup = SetupInForce();
  WatchSetup();
  PublishStatus(now_ns);
  return std::exchange(content_, {});
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
    leases_[device] = {session, ports_.now_ns() + static_cast<std::int64_t>(granted_s * 1e9)};
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
    return UsageError("device " + std::to_string(device) + " has no sphere: it is not a PS Move");
  }
  status_due_ = true;
  Flush(**found);
  return {};
}

Result<void> Hub::SetCamera(std::uint32_t device, bool on) {
  const auto found = Attached(device);
  if (!found) return found.error();
  if (!(*found)->SetCamera(on)) {
    return UsageError("device " + std::to_string(device) + " has no camera: it is not a Wiimote");
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

Result<void> Hub::AssignRole(const std::string& serial, const Binding& binding) {
  Device* const found = WithSerial(serial);
  if (found == nullptr) return NoDevice("no device with serial " + serial + " was seen");
  Device& device = *found;
  if (!RoleFits(device.kind(), binding.role)) {
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

void Hub::EndSession(std::uint64_t session) {
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
    ports_.send(device->handle(), device->kind() == DeviceKind::kPsMove ? reports::MoveLights(0, 0)
                                                                        : reports::RumbleOnly());
  }
}

}  // namespace footing::sensor
