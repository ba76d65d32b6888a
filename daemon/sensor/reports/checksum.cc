#include "daemon/sensor/reports/checksum.h"

#include <zlib.h>

#include <algorithm>

namespace footing::calibration {

std::uint8_t SumChecksum(reports::Bytes bytes) {
  std::uint8_t sum = 0x55;
  for (const std::uint8_t byte : bytes) sum = static_cast<std::uint8_t>(sum + byte);
  return sum;
}

bool EndsInSumChecksum(reports::Bytes block) {
  return !block.empty() && SumChecksum(block.first(block.size() - 1)) == block.back();
}

std::uint32_t Crc32(std::initializer_list<reports::Bytes> pieces) {
  uLong crc = crc32(0, nullptr, 0);
  for (const reports::Bytes piece : pieces) {
    crc = crc32(crc, piece.data(), static_cast<uInt>(piece.size()));
  }
  return static_cast<std::uint32_t>(crc);
}

bool AllEqual(reports::Bytes bytes, std::uint8_t value) {
  return std::all_of(bytes.begin(), bytes.end(), [value](std::uint8_t b) { return b == value; });
}

}  // namespace footing::calibration
