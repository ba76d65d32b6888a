#pragma once

#include <cstdint>
#include <span>
#include <vector>

/// The memories of a Wiimote or Balance Board, as they answer on the radio.
namespace footing::device_models {

/// Error nibbles of the replies.
inline constexpr std::uint8_t kMemoryOk = 0;
inline constexpr std::uint8_t kMemoryAbsent = 7;  ///< No such register, or nothing plugged in.
inline constexpr std::uint8_t kMemoryBeyond = 8;  ///< No such address.

/// EEPROM 0x0000 to 0x16ff, and register pages of 256 bytes: speaker (0xa2), extension (0xa4, when
/// one is plugged in) and camera (0xb0). The MotionPlus page (0xa6) is absent.
class Memory {
 public:
  explicit Memory(bool extension);

  /// Reads or writes within one space; the error nibble. On an error nothing is touched.
  std::uint8_t Read(bool registers, std::uint32_t address, std::span<std::uint8_t> out) const;
  std::uint8_t Write(bool registers, std::uint32_t address, std::span<const std::uint8_t> data);

  std::span<std::uint8_t> eeprom() { return eeprom_; }
  std::span<std::uint8_t> extension() { return extension_; }
  bool has_extension() const { return !extension_.empty(); }
  /// The extension answers in plain bytes: 0x55 was written to 0xa400f0, then 0x00 to 0xa400fb.
  bool extension_plain() const { return extension_plain_; }

 private:
  std::vector<std::uint8_t> eeprom_;
  std::vector<std::uint8_t> extension_;
  std::vector<std::uint8_t> speaker_;
  std::vector<std::uint8_t> camera_;
  bool extension_key_ = false;
  bool extension_plain_ = false;
};

}  // namespace footing::device_models
