#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/board/geometry.h"
#include "common/stream/product_ids.h"
#include "common/virtual/devices/extensions.h"

/// Simulated devices that speak the Wiimote's protocol: their common part with its memory, the Pro
/// Controller and the Balance Board.
namespace footing::virtual_devices {

/// Error nibbles of the replies.
inline constexpr std::uint8_t kMemoryOk = 0;
inline constexpr std::uint8_t kMemoryAbsent = 7;  ///< No such register, or nothing plugged in.
inline constexpr std::uint8_t kMemoryBeyond = 8;  ///< No such address.

/// EEPROM 0x0000 to 0x16ff, and register pages of 256 bytes: speaker (0xa2), extension (0xa4, when
/// one is plugged in), MotionPlus (0xa6, when there is one) and camera (0xb0). An active MotionPlus
/// answers at 0xa4, where it hides the extension behind it.
class Memory {
 public:
  explicit Memory(bool extension);

  /// Reads or writes within one space; the error nibble. On an error nothing is touched.
  std::uint8_t Read(bool registers, std::uint32_t address, std::span<std::uint8_t> out) const;
  std::uint8_t Write(bool registers, std::uint32_t address, std::span<const std::uint8_t> data);

  std::span<std::uint8_t> eeprom() { return eeprom_; }
  std::span<const std::uint8_t> camera() const { return camera_; }
  std::span<std::uint8_t> extension() { return extension_; }
  /// State of the port's detect pin.
  bool has_extension() const {
    return port_ready_ && (motion_plus_mode_ != 0 || !extension_.empty());
  }
  /// Plugs a page of 256 bytes in at 0xa4; an empty one pulls it.
  void SetExtension(std::vector<std::uint8_t> page);
  /// The same at 0xa6; it begins inactive.
  void SetMotionPlus(std::vector<std::uint8_t> page);
  bool has_motion_plus() const { return !motion_plus_.empty(); }
  /// 0: inactive; else what was written to 0xa600fe: 4 alone, 5 Nunchuk or 7 Classic through.
  std::uint8_t motion_plus_mode() const { return motion_plus_mode_; }
  /// While not ready, nothing answers at 0xa4 and 0xa6.
  void set_port_ready(bool ready) { port_ready_ = ready; }
  /// The extension answers in plain bytes: 0x55 was written to 0xa400f0, then 0x00 to 0xa400fb.
  bool extension_plain() const { return extension_plain_; }

 private:
  const std::vector<std::uint8_t>* Page(std::uint32_t page) const;
  void WriteExtension(std::size_t at, std::uint8_t value);
  void WriteMotionPlus(std::size_t at, std::uint8_t value);

  std::vector<std::uint8_t> eeprom_;
  std::vector<std::uint8_t> extension_;
  std::vector<std::uint8_t> motion_plus_;
  std::uint8_t motion_plus_mode_ = 0;
  bool port_ready_ = true;
  std::vector<std::uint8_t> speaker_;
  std::vector<std::uint8_t> camera_;
  bool extension_key_ = false;
  bool extension_plain_ = false;
};

/// Id byte and payload.
using Report = std::vector<std::uint8_t>;

/// A point that the camera sees; columns 0 to 1023, rows 0 to 767.
struct CameraPoint {
  int x = 0;
  int y = 0;
  int size = 1;  ///< 0 to 15.
};

/// Contents of one data report.
struct Readings {
  std::uint16_t buttons = 0;  ///< First button byte in bits 8 to 15.
  /// 10 bits; of y and z the lowest is not sent.
  std::array<std::uint16_t, 3> acceleration_counts{0x200, 0x200, 0x200};
  std::array<std::uint8_t, 21> extension{};
  std::array<std::optional<CameraPoint>, 4> camera;
};

/// Whether data reports of that mode have bytes of the extension.
bool CarriesExtension(std::uint8_t mode);

/// Common part of a Wiimote and a Balance Board: the device's end of the HID protocol. Bytes
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

/// How a device presents itself to the host.
struct Identity {
  std::uint32_t bus = static_cast<std::uint32_t>(stream::Bus::kBluetooth);
  std::uint32_t vendor = stream::kVendorNintendo;
  std::uint32_t product = stream::kProductFirst;
  std::string name;
  std::string serial;  ///< A Bluetooth address.
};

/// First bytes of the addresses of each kind, so that devices of one seed differ. Nobody registered
/// them: they are locally administered.
enum class SerialOf {
  kWiimote = 0x52,
  kBalanceBoard = 0x56,
  kPsMove = 0x5a,
  kProController = 0x5e,
  kJoycon = 0x62
};

/// A Bluetooth address drawn from the seed.
std::string MakeSerial(SerialOf kind, std::uint64_t seed);

/// Input of a Wii U Pro Controller's user.
struct ProControllerSensors {
  GamepadSensors gamepad;   ///< Its triggers are switches: the bits of `buttons` alone count.
  bool left_stick = false;  ///< Pressed in.
  bool right_stick = false;
};

/// A Wii U Pro Controller: a Wiimote's radio with an extension of its own, which cannot be pulled.
class ProController {
 public:
  explicit ProController(std::uint64_t seed);

  const Identity& identity() const { return identity_; }

  std::vector<Report> HandleOutput(std::span<const std::uint8_t> report) {
    return controller_.HandleOutput(report);
  }

  /// The report of one sample, when the mode calls for one; before the extension is switched to
  /// plain bytes they are of no use (FF).
  std::optional<Report> Sample(const ProControllerSensors& sensors);

  /// 0 empty to 4 full.
  void set_battery(std::uint8_t level) { battery_ = level; }
  Controller& controller() { return controller_; }

 private:
  Identity identity_;
  Controller controller_;
  std::uint8_t battery_ = 4;
};

using board::CornerForces;

/// A Balance Board: a Wiimote's radio with an extension that measures four corners.
///
/// Its cells read more than their calibration says, by 1 / 0.99908, and 0.07 % more for each step
/// of its thermometer above the calibration's: what WiiBrew found, and what a host has to take off
/// again. They feel force: the mass that gives it depends on the place's gravity, and is the
/// host's.
class BalanceBoard {
 public:
  static constexpr std::size_t kCorners = 4;  ///< Top right, bottom right, top left, bottom left.
  /// Counts at 0, 17 and 34 kg.
  using Points = std::array<int, 3>;
  /// The thermometer's byte at calibration; 0x19 in the packet of a real one.
  static constexpr std::uint8_t kReferenceTemperature = 0x19;

  /// Its calibration is drawn from the seed.
  explicit BalanceBoard(std::uint64_t seed);
  /// With the calibration of a unit that is known.
  BalanceBoard(std::uint64_t seed, const std::array<Points, kCorners>& points);

  const Identity& identity() const { return identity_; }

  std::vector<Report> HandleOutput(std::span<const std::uint8_t> report) {
    return controller_.HandleOutput(report);
  }

  std::vector<Report> HandleOutput(std::int64_t, std::span<const std::uint8_t> report) {
    return controller_.HandleOutput(report);
  }

  /// The report of one sample, when the mode calls for one; before the extension is switched to
  /// plain bytes they are of no use (FF).
  std::optional<Report> Sample(const CornerForces& forces, bool button = false);

  void set_temperature(std::uint8_t raw) { temperature_ = raw; }
  /// Byte 10; bars begin at 0x6a, 0x78, 0x7d and 0x82. The status report's byte hardly changes.
  void set_battery(std::uint8_t raw) { battery_ = raw; }

  Controller& controller() { return controller_; }
  std::uint8_t leds() const { return controller_.leds(); }  ///< Bits 0 to 3.
  bool rumble() const { return controller_.rumble(); }

  const std::array<Points, kCorners>& points() const { return points_; }

 private:
  std::array<Points, kCorners> points_;
  Identity identity_;
  Controller controller_;
  std::uint8_t temperature_ = kReferenceTemperature;
  std::uint8_t battery_ = 0x83;  ///< Four bars.
};

}  // namespace footing::virtual_devices
