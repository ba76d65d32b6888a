#pragma once

#include <cstdint>

namespace footing::device_models {

/// SplitMix64 (Steele, Lea, Flood 2014, OOPSLA, figure 5): a seeded source whose bits are the same
/// on every machine. Its whole state is one number.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  std::uint64_t Bits();
  /// In [0, 1), of 53 bits.
  double Uniform();
  /// In [low, high).
  double Uniform(double low, double high) { return low + (high - low) * Uniform(); }
  /// In low..high, both included.
  int Integer(int low, int high);

 private:
  std::uint64_t state_;
};

}  // namespace footing::device_models
