#pragma once

#include <cstdint>
#include <string>

#include "common/stream/product_ids.h"

namespace footing::virtual_devices {

/// How a device presents itself to the host.
struct Identity {
  std::uint32_t bus = static_cast<std::uint32_t>(stream::Bus::kBluetooth);
  std::uint32_t vendor = stream::kVendorNintendo;
  std::uint32_t product = stream::kProductFirst;
  std::string name;
  std::string serial;  ///< A Bluetooth address.
};

/// A Bluetooth address drawn from the seed; its first byte says that nobody registered it.
std::string MakeSerial(std::uint64_t seed);

}  // namespace footing::virtual_devices
