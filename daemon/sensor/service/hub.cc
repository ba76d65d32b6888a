#include "daemon/sensor/service/hub.h"

#include <algorithm>
#include <utility>

#include "common/base/units.h"

namespace footing::sensor {
namespace {

constexpr std::int64_t kStatusIntervalNs = 200'000'000;

}  // namespace

Hub::Hub(const Config& config, Ports ports)
    : config_(config),
      ports_(std::move(ports)),
      setup_(config_, devices_, ports_.storage, ports_.log, ports_.now_ns),
      roles_(config_.roles, setup_.roles(), ports_.log),
      rigs_(features::Named(config_.features).value_or(features::Config())),
      trackers_(config_, ports_.log, ports_.now_ns) {
  content_.config = EffectiveConfig(config_);
}

template <typename HasEnded>
void Hub::EndLeases(const HasEnded& has_ended) {
  std::erase_if(leases_, [&](const auto& lease) {
    if (!has_ended(lease.second)) return false;
    if (Device* device = devices_.Numbered(lease.first)) device->outbox().SetRumble(false);
    return true;
  });
}

void Hub::OnDetach(devices::DeviceHandle handle, const std::string& reason) {
  Device* device = devices_.Find(handle);
  if (device == nullptr) return;
  device->Detach(handle, reason);
  status_due_ = true;
  if (device->attached()) return;  // Its other link is still there.
  leases_.erase(device->number());
  const std::string& serial = device->identity().serial;
  ports_.log({"device " + std::to_string(device->number()) + " (" + serial + ") lost: " + reason,
              serial, true});
}

void Hub::AddRaw(const Device& device, std::int64_t at_ns, std::span<const std::uint8_t> bytes,
                 bool to_device, std::int64_t true_ns, bool feature) {
  if (content_.raw.size() >= kMaxSamplesPerTick) return;
  if (bytes.size() > kMaxRawBytesPerTick - raw_bytes_) return;
  raw_bytes_ += bytes.size();
  stream::RawReport raw;
  raw.device = device.number();
  raw.received_ns = at_ns;
  raw.report.assign(bytes.begin(), bytes.end());
  raw.to_device = to_device;
  raw.feature = feature;
  raw.simulated = device.simulated();
  raw.true_ns = true_ns;
  content_.raw.push_back(std::move(raw));
}

void Hub::OnReport(devices::DeviceHandle handle, const devices::IncomingReport& report) {
  Device* device = devices_.Find(handle);
  if (device == nullptr) return;
  AddRaw(*device, report.received_ns, report.bytes, false, report.true_ns, report.feature);
  const Device::Taken taken = device->Take(handle, report, content_);
  if (taken.calibration && ports_.save_calibration) {
    ports_.save_calibration(device->identity().serial, *taken.calibration);
  }
  if (taken.other_kind) Bind(*device);
  for (const stream::MotionSample& sample : taken.motion) {
    rigs_.Add(device->binding().rig, device->mounted_sensor().Take(sample), ports_.now_ns());
  }
  Flush(*device);
}

/// Writes the device's next report if one is due.
void Hub::Flush(Device& device) {
  if (!device.attached()) return;
  const std::int64_t now_ns = ports_.now_ns();
  if (ports_.request_feature) {
    if (const auto feature = device.NextFeature(now_ns)) {
      ports_.request_feature(device.feature_handle(), feature->id, feature->size);
      AddRaw(device, now_ns, std::span(&feature->id, 1), true, 0, true);
    }
  }
  const auto report = device.NextOutput(now_ns);
  if (!report) return;
  ports_.send(device.handle(), *report);
  AddRaw(device, now_ns, *report, true, 0);
}

void Hub::PublishStatus(std::int64_t now_ns) {
  std::vector<stream::DeviceState> states;
  std::vector<stream::DeviceStatus> status;
  for (const auto& device : devices_) {
    status.push_back(device->Status(now_ns, config_.stale_after_s));
    setup_.AddTo(device->placement(), status.back());
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
  EndLeases([now_ns](const Lease& lease) { return now_ns >= lease.until_ns; });
  for (const auto& device : devices_) {
    device->Advance(now_ns);
    Flush(*device);
  }
  content_.features = rigs_.Compute(now_ns, devices_, ports_.now_ns);
  if (setup_.Changed()) {
    for (const auto& device : devices_) ApplySetup(*device);
    status_due_ = true;
  }
  if (auto setup = setup_.Publish()) {
    content_.has_setup = true;
    content_.setup = *std::move(setup);
  }
  if (setup_.Watch()) status_due_ = true;
  trackers_.Publish(now_ns, content_);
  PublishStatus(now_ns);
  raw_bytes_ = 0;
  return std::exchange(content_, {});
}

// Which devices are taken, and which give way to others.
namespace {

DeviceOptions OptionsOf(const Config& config) {
  DeviceOptions options;
  options.plate = config.plate;
  options.kind.local_gravity_mps2 = config.local_gravity_mps2;
  options.kind.handshake.motion_plus = config.motion_plus;
  options.kind.handshake.camera = config.camera;
  options.kind.handshake.status_interval_s = config.status_interval_s;
  return options;
}

/// Why a second device of one serial is not taken; empty when it is.
std::string WhyNotTwice(const Device& first, const devices::DeviceIdentity& second,
                        bool second_link) {
  if (!second.simulated)
    return "";  // A real one that is found again, or in a simulated one's place.
  if (!first.simulated()) {
    return "a simulated device with the serial of the real device " + second.serial + " is ignored";
  }
  if (second_link) return "";
  return "a second simulated device with the serial " + second.serial +
         " is ignored: the first one is still there; end it, or choose another serial or seed";
}

}  // namespace

/// Later messages of its links are ignored; the caller gives its place to another.
void Hub::DropSimulated(const Device& device, const std::string& why) {
  const std::string line =
      "simulated device " + device.identity().serial + " is no longer taken: " + why;
  ports_.log({line, device.identity().serial, true});
  leases_.erase(device.number());
  if (!ports_.refuse) return;
  ports_.refuse(device.handle(), line);
  if (device.feature_handle() != device.handle()) ports_.refuse(device.feature_handle(), line);
}

std::string Hub::OnAttach(devices::DeviceHandle handle, const devices::DeviceIdentity& identity) {
  Device* device = devices_.WithSerial(identity.serial);
  const bool there = device != nullptr && device->attached();
  const bool second_link = there && device->has_second_link() &&
                           device->simulated() == identity.simulated &&
                           device->identity().bus != identity.bus;
  const std::string why = there ? WhyNotTwice(*device, identity, second_link) : "";
  if (!why.empty()) {
    ports_.log({why, identity.serial, true});
    return why;
  }
  if (second_link) {
    device->AttachSecond(handle, identity);
    status_due_ = true;
    ports_.log({"device " + std::to_string(device->number()) + " (" + identity.serial +
                    ") is on a second link: " + identity.place,
                identity.serial});
    Flush(*device);
    return "";
  }
  if (there && device->simulated()) {
    DropSimulated(*device, "the real device with this serial is there");
  }
  if (device == nullptr) {
    device = devices_.Add(
        identity.simulated, OptionsOf(config_),
        [this](const Device& other, const std::string& drop) { DropSimulated(other, drop); });
  }
  if (device == nullptr) {
    const std::string full = "more than " + std::to_string(DeviceTable::kMaxDevices) +
                             " devices: " + identity.serial + " is ignored";
    ports_.log({full, identity.serial, true});
    return full;
  }
  Device::Stored stored;
  if (ports_.load_calibration) stored = ports_.load_calibration(identity.serial);
  device->Attach(handle, identity, stored);
  Bind(*device);
  ports_.log({std::string(identity.simulated ? "simulated " : "") + stream::Name(device->kind()) +
                  " " + identity.serial + " attached as device " +
                  std::to_string(device->number()) + ", " + ToText(device->binding()) +
                  roles_.WhyOther(*device) + ": " + identity.place,
              identity.serial});
  device->Advance(ports_.now_ns());
  Flush(*device);
  return "";
}

void Hub::Bind(Device& device) {
  Rebind(device, roles_.Choose(device, devices_, config_.default_rig));
  if (device.binding().role == stream::DeviceRole::kUnspecified) return;
  for (const auto& other : devices_) {
    if (other.get() != &device && other->attached() && roles_.GivesWay(*other, device)) {
      Rebind(*other, roles_.Choose(*other, devices_, config_.default_rig));
    }
  }
}

void Hub::Rebind(Device& device, const Binding& binding) {
  device.set_binding(binding);
  status_due_ = true;
  ApplySetup(device);
  rigs_.Rebuild(devices_);
}

Result<void> Hub::AssignRole(const std::string& serial, const Binding& binding) {
  if (const auto rig = CheckRig(binding.rig); !rig) {
    return UsageError("assign_role: " + rig.error().message);
  }
  Device* const found = devices_.WithSerial(serial);
  if (found == nullptr) return NoDevice("no device with serial " + serial + " was seen");
  Device& device = *found;
  if (!RoleFits(device.placement(), binding.role)) {
    return UsageError(std::string("a ") + stream::Name(device.kind()) + " cannot be " +
                      stream::Name(binding.role));
  }
  const Binding before = device.binding();
  for (const auto& other : devices_) {
    if (other.get() == &device || other->binding() != binding) continue;
    roles_.Assign(other->identity().serial, before);
    setup_.StoreRole(other->identity().serial, before);
    Rebind(*other, before);
  }
  roles_.Assign(serial, binding);
  setup_.StoreRole(serial, binding);
  Rebind(device, binding);
  return {};
}

void Hub::ApplySetup(Device& device) {
  if (setup_.Apply(device)) rigs_.Restart(device.binding().rig);
}

// Commands to one device, and the leases of motors.
namespace {

constexpr double kDefaultLeaseS = 1;
constexpr double kMaxLeaseS = 10;

}  // namespace

Result<void> Hub::SetRumble(std::uint64_t session, std::uint32_t device, bool on, double lease_s) {
  const auto attached = devices_.Attached(device);
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
  const auto found = devices_.Attached(device);
  if (!found) return found.error();
  (*found)->SetLeds(leds);
  status_due_ = true;
  Flush(**found);
  return {};
}

Result<void> Hub::SetSphere(std::uint32_t device, std::uint32_t rgb) {
  const auto found = devices_.Attached(device);
  if (!found) return found.error();
  if (!(*found)->SetSphere(rgb)) {
    return UsageError("device " + std::to_string(device) + " has no sphere");
  }
  status_due_ = true;
  Flush(**found);
  return {};
}

Result<void> Hub::SetCamera(std::uint32_t device, bool on) {
  const auto found = devices_.Attached(device);
  if (!found) return found.error();
  if (!(*found)->SetCamera(on)) {
    return UsageError("device " + std::to_string(device) + " has no camera");
  }
  return {};
}

Result<void> Hub::RequestDeviceStatus(std::uint32_t device) {
  const auto found = devices_.Attached(device);
  if (!found) return found.error();
  if (!(*found)->RequestStatus(ports_.now_ns())) {
    return UsageError("device " + std::to_string(device) +
                      " was asked less than a second ago, or has no status report");
  }
  return {};
}

void Hub::EndSession(std::uint64_t session) {
  setup_.EndSession(session);
  EndLeases([session](const Lease& lease) { return lease.session == session; });
}

void Hub::StopMotors() {
  for (const auto& device : devices_) {
    if (!device->attached() || !device->outbox().rumble()) continue;
    device->outbox().SetRumble(false);
    ports_.send(device->handle(), device->MotorOff());
  }
}

}  // namespace footing::sensor
