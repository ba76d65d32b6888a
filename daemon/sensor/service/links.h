#pragma once

#include <optional>
#include <string>

#include "daemon/sensor/devices/source.h"

namespace footing::sensor {

/// Where a device is attached: on one link, on two at once (a PS Move: Bluetooth carries the
/// samples, USB the calibration), or on none since it was lost.
class Links {
 public:
  void Attach(devices::DeviceHandle handle, const devices::DeviceIdentity& identity);
  /// True when the second link is the one that carries the samples from now on.
  bool AttachSecond(devices::DeviceHandle handle, const devices::DeviceIdentity& identity);
  /// One link is gone; the device is lost when that was the only one.
  void Detach(devices::DeviceHandle handle, const std::string& reason);

  bool attached() const { return attached_; }
  bool Owns(devices::DeviceHandle handle) const {
    return attached_ && (handle == handle_ || (second_ && handle == *second_));
  }
  /// The link that carries the samples.
  devices::DeviceHandle handle() const { return handle_; }
  /// The link that may answer feature reports.
  devices::DeviceHandle feature_handle() const { return second_.value_or(handle_); }
  const devices::DeviceIdentity& identity() const { return identity_; }
  /// Why it was lost.
  const std::string& reason() const { return reason_; }

 private:
  bool attached_ = false;
  std::string reason_;
  devices::DeviceHandle handle_ = 0;
  devices::DeviceIdentity identity_;
  std::optional<devices::DeviceHandle> second_;
  devices::DeviceIdentity second_identity_;
};

}  // namespace footing::sensor
