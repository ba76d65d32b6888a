#pragma once

#include <cstdint>
#include <initializer_list>

#include "daemon/sensor/reports/input_report.h"

namespace footing::calibration {

/// Of the EEPROM's and the Nunchuk's blocks: the bytes' sum + 0x55, 8 bits.
std::uint8_t SumChecksum(reports::Bytes bytes);

/// Whether the block's last byte is the SumChecksum of those before it; true of the camera's block
/// (11 bytes at EEPROM 0x0000 and 0x000b) and the accelerometer's.
bool EndsInSumChecksum(reports::Bytes block);

/// CRC-32 of zlib over several pieces as if they were one.
std::uint32_t Crc32(std::initializer_list<reports::Bytes> pieces);

/// All the same byte, as a device gives that has nothing stored.
bool AllEqual(reports::Bytes bytes, std::uint8_t value);

}  // namespace footing::calibration
