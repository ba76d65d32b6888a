#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "clients/ctl/report/parse.h"

namespace footing::ctl::doctor {

/// Weight of a finding, heaviest first.
enum class Severity { kError, kWarning, kNote };

const char* Name(Severity severity);

/// One problem that the doctor found, and its remedy.
struct Finding {
  std::string id;  ///< Stable: "node_without_permission".
  Severity severity = Severity::kNote;
  std::string what;
  std::string where;   ///< A serial, a file, an adapter.
  std::string remedy;  ///< Command to type or step to take; never empty.
};

/// Everything found, errors first; within a severity in the order of the checks.
std::vector<Finding> Examine(const Facts& facts);

/// No error among them.
bool Healthy(const std::vector<Finding>& findings);

/// {ok, findings: [{id, severity, what, where, remedy}]}
nlohmann::ordered_json ToJson(const std::vector<Finding>& findings);
std::string ToText(const std::vector<Finding>& findings);

/// The ids of all checks, in order.
std::vector<std::string> CheckIds();

/// hid is loaded from Debian's initramfs, which has a copy of the options.
inline constexpr const char* kIgnoreSpecialDrivers =
    "echo 'options hid ignore_special_drivers=1' | sudo tee /etc/modprobe.d/footing.conf && sudo "
    "update-initramfs -u, then reboot";

/// Finding of a check at one place.
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
std::vector<Check> DeviceChecks();     ///< Status of each device, from footingd.
std::vector<Check> SetupChecks();      ///< Setup steps to do or redo.

/// The device is attached.
bool IsThere(const stream::DeviceStatus& device);
/// Some real device delivers data.
bool AnyRealDeviceLives(const Facts& facts);
/// "left_hand 00:1f:..", or the serial alone.
std::string Place(const stream::DeviceStatus& device);

}  // namespace footing::ctl::doctor
