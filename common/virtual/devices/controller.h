#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/virtual/devices/memory.h"

namespace footing::virtual_devices {

/// Id byte and payload.
using Report = std::vector<std::uint8_t>;

/// A point that the camera sees; columns 0 to 1023, rows 0 to 767.
struct CameraPoint {
  int x = 0;
  int y = 0;
  int size = 1;  ///< 0 to 15.
};

/// What goes into one data report.
struct Readings {
  std::uint16_t buttons = 0;  ///< First button byte in bits 8 to 15.
  /// 10 bits; of y and z the lowest is not sent.
  std::array<std::uint16_t, 3> acceleration_counts{0x200, 0x200, 0x200};
  std::array<std::uint8_t, 21> extension{};
  std::array<std::optional<CameraPoint>, 4> camera;
};

/// Whether data reports of that mode have bytes of the extension.
bool CarriesExtension(std::uint8_t mode);

/// What a Wiimote and a Balance Board have in common: the device's end of the HID protocol. Bytes
/// in, reports out; it knows no clock.
class Controller {
 public:
  explicit Controller(Memory memory) : memory_(std::move(memory)) {}

  /// The answers to one output report, in order. A report that makes no sense gets none.
  std::vector<Report> HandleOutput(std::span<const std::uint8_t> report);

  /// The data report of the mode set, when one is due: always in continuous mode, otherwise when
  /// something changed. None before a mode is set, nor after an unasked status report.
  std::optional<Report> DataReport(const Readings& readings);

  /// The status report 0x20 that comes unasked when something is plugged in or pulled.
  Report UnaskedStatus();

  Memory& memory() { return memory_; }
  const Memory& memory() const { return memory_; }
  void set_battery(std::uint8_t raw) { battery_ = raw; }
  std::uint8_t mode() const { return mode_; }
  bool continuous() const { return continuous_; }
  std::uint8_t leds() const { return leds_; }
  bool rumble() const { return rumble_; }
  /// Both enables are set, and the camera was started by its register.
  bool camera_on() const { return camera_clock_ && camera_logic_ && memory_.camera()[0x30] == 8; }
  bool speaker_on() const { return speaker_; }

 private:
  Report StatusReport() const;
  Report InterleavedReport(const Readings& readings);
  std::vector<std::uint8_t> CameraBytes(const Readings& readings, std::size_t size) const;
  Report Acknowledge(std::uint8_t report, std::uint8_t error) const;
  void AnswerMode(std::span<const std::uint8_t> report, std::vector<Report>& answers);
  void AnswerWrite(std::span<const std::uint8_t> report, std::vector<Report>& answers);
  void AnswerRead(std::span<const std::uint8_t> report, std::vector<Report>& answers) const;

  Memory memory_;
  std::uint8_t battery_ = 0xc0;
  std::uint8_t mode_ = 0;  ///< 0: none set.
  bool continuous_ = false;
  std::uint8_t leds_ = 0;
  bool rumble_ = false;
  bool camera_clock_ = false;
  bool camera_logic_ = false;
  bool speaker_ = false;
  bool second_half_ = false;  ///< The next of 0x3e and 0x3f in turn.
  Readings held_;             ///< One moment in both halves.
  std::uint16_t buttons_ = 0;
  Report last_data_;
};

}  // namespace footing::virtual_devices
