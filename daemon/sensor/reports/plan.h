#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "daemon/sensor/reports/output_report.h"

namespace footing::handshake {

/// A block of memory that is read once.
struct Block {
  reports::Space space = reports::Space::kRegisters;
  std::uint32_t address = 0;
  std::uint16_t size = 0;
};

/// What sets the handshake of one kind of device apart. A remote has an accelerometer, a camera and
/// an extension port where accessories come and go; of any other kind, what answers at the port is
/// the device itself.
struct Plan {
  bool remote = false;
  std::uint8_t mode = 0;  ///< Id of the data reports; a remote's follows what is plugged in.
  /// Bytes 4 and 5 of the identity of what answers at the port: recognises the kind where its
  /// product name is missing.
  std::array<std::uint8_t, 2> identity = {};
  std::span<const Block> blocks = {};  ///< Read after the identity, in this order.
};

}  // namespace footing::handshake
