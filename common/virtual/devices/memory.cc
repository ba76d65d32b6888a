#include "common/virtual/devices/memory.h"

#include <algorithm>
#include <utility>

namespace footing::virtual_devices {
namespace {

constexpr std::size_t kEepromBytes = 0x1700;
constexpr std::size_t kRegisterPageBytes = 0x100;
constexpr std::uint32_t kSpeakerPage = 0xa200;
constexpr std::uint32_t kExtensionPage = 0xa400;
constexpr std::uint32_t kMotionPlusPage = 0xa600;
constexpr std::uint32_t kCameraPage = 0xb000;
constexpr std::size_t kKeyRegister = 0xf0;
constexpr std::size_t kPlainRegister = 0xfb;
constexpr std::size_t kModeRegister = 0xfe;
constexpr std::size_t kIdentity = 0xfa;

bool Holds(std::size_t size, std::size_t at, std::size_t count) {
  return count <= size && at <= size - count;
}

}  // namespace

Memory::Memory(bool extension)
    : eeprom_(kEepromBytes, 0),
      extension_(extension ? kRegisterPageBytes : 0, 0),
      speaker_(kRegisterPageBytes, 0),
      camera_(kRegisterPageBytes, 0) {}

const std::vector<std::uint8_t>* Memory::Page(std::uint32_t page) const {
  if (page == kSpeakerPage) return &speaker_;
  if (page == kCameraPage) return &camera_;
  if (!port_ready_) return nullptr;
  if (page == kExtensionPage) return motion_plus_mode_ != 0 ? &motion_plus_ : &extension_;
  if (page == kMotionPlusPage && motion_plus_mode_ == 0) return &motion_plus_;
  return nullptr;
}

std::uint8_t Memory::Read(bool registers, std::uint32_t address,
                          std::span<std::uint8_t> out) const {
  if (!registers) {
    if (!Holds(eeprom_.size(), address, out.size())) return kMemoryBeyond;
    std::copy_n(eeprom_.begin() + address, out.size(), out.begin());
    return kMemoryOk;
  }
  const std::size_t at = address & 0xff;
  const std::vector<std::uint8_t>* bytes = Page(address >> 8);
  if (bytes == nullptr || !Holds(bytes->size(), at, out.size())) return kMemoryAbsent;
  std::copy_n(bytes->begin() + static_cast<std::ptrdiff_t>(at), out.size(), out.begin());
  // Without the key the real bytes come encrypted; what matters is that they are of no use.
  if (bytes == &extension_ && !extension_plain_) std::fill(out.begin(), out.end(), 0xff);
  return kMemoryOk;
}

std::uint8_t Memory::Write(bool registers, std::uint32_t address,
                           std::span<const std::uint8_t> data) {
  if (!registers) {
    if (!Holds(eeprom_.size(), address, data.size())) return kMemoryBeyond;
    std::copy(data.begin(), data.end(), eeprom_.begin() + address);
    return kMemoryOk;
  }
  const std::size_t at = address & 0xff;
  const std::vector<std::uint8_t>* bytes = Page(address >> 8);
  if (bytes == nullptr || !Holds(bytes->size(), at, data.size())) return kMemoryAbsent;
  // Identities and calibrations are read-only; 0xf0, 0xfb and 0xfe are commands.
  if (bytes == &speaker_ || bytes == &camera_) {
    auto& page = bytes == &speaker_ ? speaker_ : camera_;
    std::copy(data.begin(), data.end(), page.begin() + static_cast<std::ptrdiff_t>(at));
  } else if (data.size() == 1) {
    if (bytes == &extension_) {
      WriteExtension(at, data[0]);
    } else {
      WriteMotionPlus(at, data[0]);
    }
  }
  return kMemoryOk;
}

void Memory::WriteExtension(std::size_t at, std::uint8_t value) {
  if (at == kKeyRegister) {
    extension_key_ = value == 0x55;
    extension_plain_ = false;
  } else if (at == kPlainRegister) {
    extension_plain_ = extension_key_ && value == 0x00;
  }
}

void Memory::WriteMotionPlus(std::size_t at, std::uint8_t value) {
  if (motion_plus_mode_ != 0) {
    // The key ends the pass-through, and begins the initialisation of the extension behind.
    if (at != kKeyRegister || value != 0x55) return;
    motion_plus_mode_ = 0;
    motion_plus_[kIdentity + 2] = 0xa6;
    motion_plus_[kIdentity + 4] = 0x00;
    WriteExtension(at, value);
  } else if (at == kModeRegister && (value == 4 || value == 5 || value == 7)) {
    motion_plus_mode_ = value;
    motion_plus_[kIdentity + 2] = 0xa4;
    motion_plus_[kIdentity + 4] = value;
    // It keeps a copy of the calibration of the extension that it passes through.
    if (value != 4 && !extension_.empty()) {
      std::copy_n(extension_.begin() + 0x20, 16, motion_plus_.begin() + 0x40);
    }
  }
}

void Memory::SetExtension(std::vector<std::uint8_t> page) {
  extension_ = std::move(page);
  extension_key_ = false;
  extension_plain_ = false;
}

void Memory::SetMotionPlus(std::vector<std::uint8_t> page) {
  motion_plus_ = std::move(page);
  motion_plus_mode_ = 0;
}

}  // namespace footing::virtual_devices
