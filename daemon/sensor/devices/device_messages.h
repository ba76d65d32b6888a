#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "daemon/sensor/reports/output_report.h"

/// What footingd says on the device socket: serialised DeviceEnvelopes.
namespace footing::devices {

std::string OutputMessage(std::uint32_t slot, const reports::OutputReport& report);
/// Asks for a feature report of `size` bytes, id included.
std::string FeatureRequestMessage(std::uint32_t slot, std::uint8_t id, std::size_t size);
std::string RefusedMessage(std::uint32_t slot, const std::string& why);

}  // namespace footing::devices
