#pragma once

#include <cstdint>
#include <string>

namespace footing::virtual_devices {

/// How a device presents itself to the host.
struct Identity {
  std::uint32_t bus = 5;  ///< Bluetooth, as in the kernel's input.h.
  std::uint32_t vendor = 0x057e;
  std::uint32_t product = 0x0306;  ///< Wiimote and Balance Board alike.
  std::string name;
  std::string serial;  ///< A Bluetooth address.
};

/// A Bluetooth address drawn from the seed; its first byte says that nobody registered it.
std::string MakeSerial(std::uint64_t seed);

}  // namespace footing::virtual_devices
