#pragma once

#include <cstdint>
#include <vector>

#include "common/virtual/devices/controller.h"

/// Writes of a host to a device.
namespace footing::virtual_devices {

inline Report ReadRequest(bool registers, std::uint32_t address, std::uint16_t size) {
  return {0x17,
          static_cast<std::uint8_t>(registers ? 4 : 0),
          static_cast<std::uint8_t>(address >> 16),
          static_cast<std::uint8_t>(address >> 8),
          static_cast<std::uint8_t>(address),
          static_cast<std::uint8_t>(size >> 8),
          static_cast<std::uint8_t>(size)};
}

inline Report WriteRequest(bool registers, std::uint32_t address, std::vector<std::uint8_t> data) {
  Report report = ReadRequest(registers, address, 0);
  report[0] = 0x16;
  report[5] = static_cast<std::uint8_t>(data.size());
  report.resize(6);
  report.insert(report.end(), data.begin(), data.end());
  report.resize(22, 0);
  return report;
}

}  // namespace footing::virtual_devices
