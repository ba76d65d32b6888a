#pragma once

#include <string>
#include <vector>

#include "clients/ctl/report/doctor.h"

namespace footing::ctl::doctor {

/// hid is loaded from Debian's initramfs, which has a copy of the options.
inline constexpr const char* kIgnoreSpecialDrivers =
    "echo 'options hid ignore_special_drivers=1' | sudo tee /etc/modprobe.d/footing.conf && sudo "
    "update-initramfs -u, then reboot";

/// What a check found at one place.
struct Symptom {
  Severity severity = Severity::kError;
  std::string what;
  std::string where;
  std::string remedy;
};

/// One rule: its id and what it finds.
struct Check {
  const char* id;
  std::vector<Symptom> (*find)(const Facts&);
};

std::vector<Check> HostChecks();       ///< Processes, rights, kernel drivers.
std::vector<Check> BluetoothChecks();  ///< Adapters, BlueZ, pairing.
std::vector<Check> DeviceChecks();     ///< What footingd says of each device.
std::vector<Check> SetupChecks();      ///< What is to be done or redone.

/// The device is attached.
bool IsThere(const stream::DeviceStatus& device);
/// Some real device delivers data.
bool AnyRealDeviceLives(const Facts& facts);
/// "left_hand 00:1f:..", or the serial alone.
std::string Place(const stream::DeviceStatus& device);

}  // namespace footing::ctl::doctor
