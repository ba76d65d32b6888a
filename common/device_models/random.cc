#include "common/device_models/random.h"

namespace footing::device_models {

std::uint64_t Random::Bits() {
  state_ += 0x9e3779b97f4a7c15u;
  std::uint64_t bits = state_;
  bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9u;
  bits = (bits ^ (bits >> 27)) * 0x94d049bb133111ebu;
  return bits ^ (bits >> 31);
}

double Random::Uniform() { return static_cast<double>(Bits() >> 11) * 0x1.0p-53; }

int Random::Integer(int low, int high) {
  return low + static_cast<int>(Uniform() * (high - low + 1));
}

}  // namespace footing::device_models
