// Which devices are taken, and which give way to others.
#include <algorithm>

#include "daemon/sensor/service/hub.h"

namespace footing::sensor {
namespace {

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

/// A new Device; null when there is no place for it.
Device* Hub::AddDevice(bool simulated) {
  if (devices_.size() >= kMaxDevices && !FreePlaceFor(simulated)) return nullptr;
  DeviceOptions options;
  options.plate = config_.plate;
  options.kind.local_gravity_mps2 = config_.local_gravity_mps2;
  options.kind.handshake.motion_plus = config_.motion_plus;
  options.kind.handshake.camera = config_.camera;
  options.kind.handshake.status_interval_s = config_.status_interval_s;
  devices_.push_back(std::make_unique<Device>(++last_number_, options));
  return devices_.back().get();
}

bool Hub::FreePlaceFor(bool simulated) {
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
  DropSimulated(**newest, "there are " + std::to_string(kMaxDevices) +
                              " devices already, and a real device takes its place");
  devices_.erase(std::next(newest).base());
  return true;
}

/// What its links send from now on is ignored; the caller gives its place to another.
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
  Device* device = WithSerial(identity.serial);
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
  if (device == nullptr) device = AddDevice(identity.simulated);
  if (device == nullptr) {
    const std::string full =
        "more than " + std::to_string(kMaxDevices) + " devices: " + identity.serial + " is ignored";
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
                  WhyOtherRole(*device) + ": " + identity.place,
              identity.serial});
  device->Advance(ports_.now_ns());
  Flush(*device);
  return "";
}

}  // namespace footing::sensor
