#include "common/device_models/identity.h"

#include "common/synthetic/random.h"

namespace footing::device_models {

std::string MakeSerial(std::uint64_t seed) {
  constexpr char kDigits[] = "0123456789abcdef";
  synthetic::Random random(seed);
  std::string serial = "52";  // Locally administered, unicast.
  for (int i = 0; i < 5; ++i) {
    serial += ':';
    serial += kDigits[static_cast<int>(random.Uniform(0, 16))];
    serial += kDigits[static_cast<int>(random.Uniform(0, 16))];
  }
  return serial;
}

}  // namespace footing::device_models
