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

/// First bytes of the addresses of each kind, so that devices of one seed differ. Nobody registered
/// them: they are locally administered.
enum class SerialOf {
  kWiimote = 0x52,
  kBalanceBoard = 0x56,
  kPsMove = 0x5a,
  kProController = 0x5e
};

/// A Bluetooth address drawn from the seed.
std::string MakeSerial(SerialOf kind, std::uint64_t seed);

}  // namespace footing::virtual_devices
