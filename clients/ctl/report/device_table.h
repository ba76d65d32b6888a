#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "common/base/result.h"
#include "common/stream/device.h"
#include "common/stream/setup.h"

namespace footing::ctl::display {

/// All that is known of a device. battery_fraction and clock_offset_sd_ms are null while unknown;
/// leds is text such as "1000", sphere such as "#00ff40".
nlohmann::ordered_json DeviceToJson(const stream::DeviceStatus& device);
nlohmann::ordered_json DevicesToJson(const std::vector<stream::DeviceStatus>& devices);

/// A line a device, and below it the notes of those that need a hand.
std::string DeviceTable(const std::vector<stream::DeviceStatus>& devices);

/// "main/left_hand", or "-".
std::string RigRole(const stream::DeviceStatus& device);
/// "87 %", "12 % LOW", or "-" while unknown.
std::string Battery(const stream::DeviceStatus& device);

/// Setup of every rig, with all items, as JSON.
nlohmann::ordered_json SetupToJson(const std::vector<stream::RigSetup>& rigs);
/// Every item with its date, residual and whether it is to be redone.
std::string SetupTable(const std::vector<stream::RigSetup>& rigs);

/// The device that a person names: by serial (any case), by its number, by RIG/ROLE, or by ROLE
/// alone where only one rig has it. A device that is lost counts only by its serial or number.
/// NoDevice with a list of what there is otherwise.
Result<stream::DeviceStatus> FindDevice(const std::vector<stream::DeviceStatus>& devices,
                                        const std::string& name);

/// The boards for a command to all of them.
struct Boards {
  std::vector<stream::DeviceStatus> there;
  /// Lost ones with a role that no other device has taken.
  std::vector<stream::DeviceStatus> lost;
};
/// Boards among the devices.
Boards BoardsOf(const std::vector<stream::DeviceStatus>& devices);

/// Those of `now` whose rig or role is another one than `before`.
std::vector<stream::DeviceStatus> Reassigned(const std::vector<stream::DeviceStatus>& before,
                                             const std::vector<stream::DeviceStatus>& now);

/// "main/left_hand" into its two parts. Usage error with the roles that there are otherwise.
Result<std::pair<std::string, stream::DeviceRole>> ParseRigRole(const std::string& text);

}  // namespace footing::ctl::display
