#include "common/virtual/devices/identity.h"

#include "common/virtual/noise/random.h"

namespace footing::virtual_devices {

std::string MakeSerial(std::uint64_t seed) {
  constexpr char kDigits[] = "0123456789abcdef";
  noise::Random random(seed);
  std::string serial = "52";  // Locally administered, unicast.
  for (int i = 0; i < 5; ++i) {
    serial += ':';
    serial += kDigits[static_cast<int>(random.Uniform(0, 16))];
    serial += kDigits[static_cast<int>(random.Uniform(0, 16))];
  }
  return serial;
}

}  // namespace footing::virtual_devices
