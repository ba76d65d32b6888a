#pragma once

#include <cmath>
#include <cstdint>

/// What the made devices measure: a ramp that names every sample, so that a client that gets only
/// some of them knows how many are missing and whether one came twice.
namespace footing::vm {

inline constexpr int kRampSteps = 64;
inline constexpr std::int64_t kSamplePeriodNs = 10'000'000;  ///< 100 Hz.

/// A line of kRampSteps values; its step must be more than a count of the device.
struct Ramp {
  double base = 0;
  double step = 0;

  double At(std::uint64_t sample) const {
    return base + step * static_cast<double>(sample % kRampSteps);
  }
  /// Which of the steps it was; out of 0..kRampSteps-1 when the value is not of the ramp.
  int StepOf(double value) const { return static_cast<int>(std::lround((value - base) / step)); }
};

/// x of a Wiimote's specific force; a count is 0.09 m/s2.
inline constexpr Ramp kForceRampMps2{-9.6, 0.3};
/// Top left of a Balance Board; a count is 0.1 N.
inline constexpr Ramp kCornerRampN{100, 2};

}  // namespace footing::vm
