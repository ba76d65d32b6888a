#pragma once

#include <bit>
#include <cstdint>
#include <span>

namespace footing::motion {

inline constexpr std::size_t kC3dBlock = 512;   ///< Sections begin at multiples of it.
inline constexpr std::uint8_t kC3dMark = 0x50;  ///< Second byte of the file.

/// Which machine wrote a C3D file; the number is what the file has for it.
enum class Processor { kIntel = 84, kDec = 85, kMips = 86 };

/// Numbers out of the bytes of a C3D file. The caller has checked that they are there.
class C3dReader {
 public:
  C3dReader(std::span<const std::uint8_t> bytes, Processor processor)
      : bytes_(bytes), processor_(processor) {}

  bool Has(std::size_t at, std::size_t count) const {
    return at <= bytes_.size() && count <= bytes_.size() - at;
  }
  std::uint8_t Byte(std::size_t at) const { return bytes_[at]; }
  std::uint16_t Unsigned(std::size_t at) const {
    const unsigned first = bytes_[at], second = bytes_[at + 1];
    return static_cast<std::uint16_t>(processor_ == Processor::kMips ? first << 8 | second
                                                                     : second << 8 | first);
  }
  std::int16_t Signed(std::size_t at) const { return static_cast<std::int16_t>(Unsigned(at)); }
  float Float(std::size_t at) const {
    const std::uint32_t first = Unsigned(at), second = Unsigned(at + 2);
    if (processor_ == Processor::kIntel) return std::bit_cast<float>(second << 16 | first);
    if (processor_ == Processor::kMips) return std::bit_cast<float>(first << 16 | second);
    // DEC: the high word first, and an exponent that is two more.
    return std::bit_cast<float>(first << 16 | second) / 4;
  }

 private:
  std::span<const std::uint8_t> bytes_;
  Processor processor_;
};

}  // namespace footing::motion
