#include "daemon/sensor/service/hub.h"

#include <utility>

namespace footing::sensor {
namespace {

constexpr std::int64_t kStatusIntervalNs = 200'000'000;

}  // namespace

Hub::Hub(const Config& config, Ports ports)
    : config_(config), ports_(std::move(ports)), store_(ports_.storage) {
  for (const auto& [serial, text] : config_.roles) {
    if (auto binding = ParseBinding(text)) assigned_[serial] = std::move(binding).value();
  }
  for (const auto& [serial, text] : store_.roles()) {
    auto binding = ParseBinding(text);
    if (!binding) {
      ports_.log({"the stored role of " + serial + " is ignored: " + binding.error().message,
                  serial, true});
      continue;
    }
    const auto configured = assigned_.find(serial);
    if (configured != assigned_.end() && configured->second != *binding) {
      ports_.log({serial + " is " + text + " by the last command, no longer " +
                      config_.roles.at(serial) + " as in the config",
                  serial});
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

void Hub::OnDetach(devices::DeviceHandle handle, const std::string& reason) {
  Device* device = Find(handle);
  if (device == nullptr) return;
  device->Detach(handle, reason);
  status_due_ = true;
  if (device->attached()) return;  // Its other link is still there.
  leases_.erase(device->number());
  const std::string& serial = device->identity().serial;
  ports_.log({"device " + std::to_string(device->number()) + " (" + serial + ") lost: " + reason,
              serial, true});
}

void Hub::TakeRaw(const Device& device, std::int64_t at_ns, std::span<const std::uint8_t> bytes,
                  bool to_device, std::int64_t true_ns, bool feature) {
  if (content_.raw.size() >= kMaxSamplesPerTick || bytes.size() > 64) return;
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

void Hub::AddToRig(const Device& device, const stream::MotionSample& sample) {
  const auto rig = rigs_.find(device.binding().rig);
  if (rig == rigs_.end()) return;
  rig->second.extractor->AddSample(sample);
  rig->second.decoded_ns = ports_.now_ns();
}

void Hub::OnReport(devices::DeviceHandle handle, const devices::IncomingReport& report) {
  Device* device = Find(handle);
  if (device == nullptr) return;
  TakeRaw(*device, report.received_ns, report.bytes, false, report.true_ns, report.feature);
  const stream::DeviceKind kind = device->kind();
  const std::size_t before = content_.motion.size();
  device->Take(handle, report, content_);
  if (const auto fresh = device->TakeFreshCalibration(); fresh && ports_.save_calibration) {
    ports_.save_calibration(device->identity().serial, *fresh);
  }
  if (device->kind() != kind) Bind(*device);
  for (std::size_t i = before; i < content_.motion.size(); ++i) {
    AddToRig(*device, device->mounted_sensor().Take(content_.motion[i]));
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
      TakeRaw(device, now_ns, std::span(&feature->id, 1), true, 0, true);
    }
  }
  const auto report = device.NextOutput(now_ns);
  if (!report) return;
  ports_.send(device.handle(), *report);
  TakeRaw(device, now_ns, *report, true, 0);
}

void Hub::PublishStatus(std::int64_t now_ns) {
  std::vector<stream::DeviceState> states;
  std::vector<stream::DeviceStatus> status;
  for (const auto& device : devices_) {
    status.push_back(device->Status(now_ns, config_.stale_after_s));
    AddSetupTo(device->placement(), status.back());
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
  if (store_.revision() != published_revision_) {
    published_revision_ = store_.revision();
    content_.has_setup = true;
    ApplySetupToAll();
  }
  if (std::set<std::string> rigs = RigsWithBoards(); rigs != published_board_rigs_) {
    published_board_rigs_ = std::move(rigs);
    content_.has_setup = true;
  }
  if (content_.has_setup) content_.setup = SetupInForce();
  WatchSetup();
  for (const std::string& line : refusals_.Due(now_ns)) ports_.log({line, "", true});
  PublishStatus(now_ns);
  PublishExposures();
  return std::exchange(content_, {});
}

}  // namespace footing::sensor
