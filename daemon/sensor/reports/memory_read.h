#pragma once

#include <cstdint>
#include <vector>

#include "daemon/sensor/reports/output_report.h"

namespace footing::reports {

/// One memory read under way: puts the pieces of at most 16 bytes together.
///
/// Replies carry only the low 16 bits of the address, and others (the kernel's driver) read the
/// same device, so a reply counts only if it has the offset that is due and fits in what is still
/// missing.
class MemoryRead {
 public:
  enum class Progress { kForeign, kMore, kDone, kRefused };

  MemoryRead(Space space, std::uint32_t address, std::uint16_t size)
      : space_(space), address_(address), size_(size) {}

  /// Asks for what is still missing.
  OutputReport Request() const;
  Progress Take(const MemoryData& reply);
  /// Throws away what has come, for another try from the start.
  void Restart() { bytes_.clear(); }

  const std::vector<std::uint8_t>& bytes() const { return bytes_; }
  /// Of the reply that was refused: 7 or 8.
  std::uint8_t error() const { return error_; }

 private:
  Space space_;
  std::uint32_t address_;
  std::uint16_t size_;
  std::vector<std::uint8_t> bytes_;
  std::uint8_t error_ = 0;
};

}  // namespace footing::reports
