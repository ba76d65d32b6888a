#pragma once

#include <cstdint>
#include <vector>

#include "daemon/sensor/reports/input_report.h"

namespace footing::reports {

/// Id byte and payload, as hid_write takes it.
using OutputReport = std::vector<std::uint8_t>;

/// Address spaces of a Wiimote.
enum class Space {
  kEeprom,     ///< 0x0000 to 0x16ff.
  kRegisters,  ///< 0xa20000 speaker, 0xa40000 extension, 0xa60000 MotionPlus, 0xb00000 camera.
};

/// Changes nothing but the rumble bit, which the Outbox sets.
OutputReport RumbleOnly();
/// `leds`: bits 0 to 3.
OutputReport SetLeds(std::uint8_t leds);
/// `continuous`: reports come at the device's own rate, also when nothing changes.
OutputReport SetMode(std::uint8_t data_report_id, bool continuous);
/// Asks for a status report.
OutputReport RequestStatus();
/// `data`: 1 to 16 bytes.
OutputReport WriteMemory(Space space, std::uint32_t address, Bytes data);
/// Asks for `size` bytes; they come in memory reports of up to 16 bytes each.
OutputReport ReadMemory(Space space, std::uint32_t address, std::uint16_t size);

/// Every output report carries the rumble bit; the motor stops at one without it. Called at the
/// single place that sends.
void SetRumbleBit(OutputReport& report, bool on);

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
  /// Error code of the reply that was refused: 7 or 8.
  std::uint8_t error() const { return error_; }

 private:
  Space space_;
  std::uint32_t address_;
  std::uint16_t size_;
  std::vector<std::uint8_t> bytes_;
  std::uint8_t error_ = 0;
};

}  // namespace footing::reports
