#include "common/device_models/memory.h"

#include <algorithm>

namespace footing::device_models {
namespace {

constexpr std::size_t kEepromBytes = 0x1700;
constexpr std::size_t kPageBytes = 0x100;
constexpr std::uint32_t kSpeakerPage = 0xa200;
constexpr std::uint32_t kExtensionPage = 0xa400;
constexpr std::uint32_t kCameraPage = 0xb000;
constexpr std::size_t kKeyRegister = 0xf0;
constexpr std::size_t kPlainRegister = 0xfb;

bool Holds(std::size_t size, std::size_t at, std::size_t count) {
  return count <= size && at <= size - count;
}

}  // namespace

Memory::Memory(bool extension)
    : eeprom_(kEepromBytes, 0),
      extension_(extension ? kPageBytes : 0, 0),
      speaker_(kPageBytes, 0),
      camera_(kPageBytes, 0) {}

std::uint8_t Memory::Read(bool registers, std::uint32_t address,
                          std::span<std::uint8_t> out) const {
  if (!registers) {
    if (!Holds(eeprom_.size(), address, out.size())) return kMemoryBeyond;
    std::copy_n(eeprom_.begin() + address, out.size(), out.begin());
    return kMemoryOk;
  }
  const std::uint32_t page = address >> 8;
  const std::size_t at = address & 0xff;
  const std::vector<std::uint8_t>* bytes = page == kExtensionPage ? &extension_
                                           : page == kSpeakerPage ? &speaker_
                                           : page == kCameraPage  ? &camera_
                                                                  : nullptr;
  if (bytes == nullptr || !Holds(bytes->size(), at, out.size())) return kMemoryAbsent;
  std::copy_n(bytes->begin() + static_cast<std::ptrdiff_t>(at), out.size(), out.begin());
  // Without the key the real bytes come encrypted; what matters is that they are of no use.
  if (page == kExtensionPage && !extension_plain_) std::fill(out.begin(), out.end(), 0xff);
  return kMemoryOk;
}

std::uint8_t Memory::Write(bool registers, std::uint32_t address,
                           std::span<const std::uint8_t> data) {
  if (!registers) {
    if (!Holds(eeprom_.size(), address, data.size())) return kMemoryBeyond;
    std::copy(data.begin(), data.end(), eeprom_.begin() + address);
    return kMemoryOk;
  }
  const std::uint32_t page = address >> 8;
  const std::size_t at = address & 0xff;
  std::vector<std::uint8_t>* bytes = page == kExtensionPage ? &extension_
                                     : page == kSpeakerPage ? &speaker_
                                     : page == kCameraPage  ? &camera_
                                                            : nullptr;
  if (bytes == nullptr || !Holds(bytes->size(), at, data.size())) return kMemoryAbsent;
  // The identity at 0xfa to 0xff and the calibration are read-only; 0xf0 and 0xfb are commands.
  if (page != kExtensionPage) {
    std::copy(data.begin(), data.end(), bytes->begin() + static_cast<std::ptrdiff_t>(at));
  } else if (at == kKeyRegister && data.size() == 1) {
    extension_key_ = data[0] == 0x55;
    extension_plain_ = false;
  } else if (at == kPlainRegister && data.size() == 1) {
    extension_plain_ = extension_key_ && data[0] == 0x00;
  }
  return kMemoryOk;
}

}  // namespace footing::device_models
