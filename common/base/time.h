#pragma once

#include <cmath>
#include <cstdint>

/// Conversions of instants and durations that units.h lacks: SecondsToNanoseconds there cuts off.
namespace footing {

inline constexpr std::int64_t kNanosecondsPerMillisecond = 1'000'000;

/// To the nearest nanosecond.
inline std::int64_t RoundToNanoseconds(double seconds) { return std::llround(seconds * 1e9); }

constexpr double NanosecondsToMilliseconds(std::int64_t nanoseconds) {
  return static_cast<double>(nanoseconds) * 1e-6;
}

/// The length of one period, cut off to nanoseconds; `rate_hz` is positive.
constexpr std::int64_t PeriodNanoseconds(double rate_hz) {
  return static_cast<std::int64_t>(1e9 / rate_hz);
}

}  // namespace footing
