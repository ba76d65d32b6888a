#pragma once

#include <cstdint>
#include <span>
#include <vector>

/// The memories of a Wiimote or Balance Board, as they answer on the radio.
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
  /// What the detect pin of the port says.
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
  bool port_ready() const { return port_ready_; }
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

}  // namespace footing::virtual_devices
