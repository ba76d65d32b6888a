#pragma once

#include <cmath>

namespace footing::motion {

inline bool IsRate(double rate_hz) { return rate_hz >= 0.1 && rate_hz <= 100'000; }

/// Rate of a step that a file gives with few digits: 0.0083333 s is 120 Hz, not 120.0005.
inline double RateOfStep(double step_s) {
  const double rate_hz = 1 / step_s;
  const double whole = std::round(rate_hz);
  return whole > 0 && std::abs(rate_hz - whole) < 1e-4 * whole ? whole : rate_hz;
}

}  // namespace footing::motion
