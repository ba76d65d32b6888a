#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

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

nlohmann::ordered_json SetupToJson(const std::vector<stream::RigSetup>& rigs);
/// Every item with its date, residual and whether it is to be redone.
std::string SetupTable(const std::vector<stream::RigSetup>& rigs);

}  // namespace footing::ctl::display
