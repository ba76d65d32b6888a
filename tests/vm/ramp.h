#pragma once

#include <cmath>
#include <cstdint>

/// Samples of the synthetic devices: a ramp that names every sample, so that a client that gets
/// only some of them knows how many are missing and whether one came twice.
namespace footing::vm {

inline constexpr std::int64_t kSamplePeriodNs = 10'000'000;  ///< 100 Hz.

/// So many values on a line, over and over; its step must be more than a count of the device.
struct Ramp {
  double base = 0;
  double step = 0;
  int steps = 256;

  double At(std::uint64_t sample) const {
    return base + step * static_cast<double>(sample % static_cast<std::uint64_t>(steps));
  }
  /// Which of the steps it was; out of 0..steps-1 when the value is not of the ramp.
  int StepOf(double value) const { return static_cast<int>(std::lround((value - base) / step)); }
};

/// x of a Wiimote's specific force; a count is 0.09 m/s2, and the range ends beyond 4 g.
inline constexpr Ramp kForceRampMps2{-25.6, 0.2};
/// x of a PS Move's; a count is 0.0023 m/s2. At 200 samples a second it lasts for 80 s: the first
/// type's older sample is half way from the report before, which would be no step where it wraps.
inline constexpr Ramp kMoveRampMps2{-40.96, 0.005, 16384};
/// Top left of a Balance Board; a count is 0.1 N.
inline constexpr Ramp kCornerRampN{100, 2};

}  // namespace footing::vm
