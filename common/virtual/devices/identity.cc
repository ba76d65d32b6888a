#include "common/virtual/devices/identity.h"

#include "common/virtual/devices/random.h"

namespace footing::virtual_devices {

std::string MakeSerial(SerialOf kind, std::uint64_t seed) {
  constexpr char kDigits[] = "0123456789abcdef";
  noise::Random random(seed);
  const auto first = static_cast<unsigned>(kind);
  std::string serial = {kDigits[first >> 4], kDigits[first & 15]};
  for (int i = 0; i < 5; ++i) {
    serial += ':';
    serial += kDigits[static_cast<int>(random.Uniform(0, 16))];
    serial += kDigits[static_cast<int>(random.Uniform(0, 16))];
  }
  return serial;
}

}  // namespace footing::virtual_devices
