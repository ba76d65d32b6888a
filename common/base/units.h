#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

/// The few constants that turn edge units (g, degrees, kilograms on a scale) into SI and back.
namespace footing {

/// Standard gravity: what 1 g on a calibration sheet and 1 kg on a scale mean (CGPM 1901).
inline constexpr double kStandardGravityMps2 = 9.80665;

inline constexpr double kPi = std::numbers::pi;

inline constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;

/// Angles at the edge are in degrees; everywhere else they are in radians.
constexpr double DegreesToRadians(double degrees) { return degrees * kPi / 180.0; }
constexpr double RadiansToDegrees(double radians) { return radians * 180.0 / kPi; }

/// Mass shown on a scale to the force behind it, and back.
constexpr double KilogramsToNewtons(double kilograms) { return kilograms * kStandardGravityMps2; }
constexpr double NewtonsToKilograms(double newtons) { return newtons / kStandardGravityMps2; }

/// Durations in seconds to nanoseconds, cut off towards 0, and back.
constexpr std::int64_t SecondsToNanoseconds(double seconds) {
  return static_cast<std::int64_t>(seconds * 1e9);
}
constexpr double NanosecondsToSeconds(std::int64_t nanoseconds) {
  return static_cast<double>(nanoseconds) * 1e-9;
}

/// The value itself, or 0 where it is infinite or NaN.
inline double FiniteOrZero(double value) { return std::isfinite(value) ? value : 0; }

/// The same angle in (-pi, pi]. `radians` must be finite.
double WrapAngle(double radians);

/// `angle_rad` plus the whole turns that bring it nearest to `reference_rad`; both finite.
inline double NearestTurn(double angle_rad, double reference_rad) {
  return angle_rad + 2 * kPi * std::round((reference_rad - angle_rad) / (2 * kPi));
}

// Stamps that come from files and other programs may be anything; clocks reach only some of them.

/// Instants and offsets beyond it, 73 years either way, are refused: sums of three of them cannot
/// overflow.
inline constexpr std::int64_t kMostInstantNs = std::int64_t{1} << 61;

/// Whether a stamp is within kMostInstantNs.
constexpr bool IsInstant(std::int64_t time_ns) {
  return time_ns >= -kMostInstantNs && time_ns <= kMostInstantNs;
}
constexpr bool IsInstant(std::uint64_t time_ns) {
  return time_ns <= static_cast<std::uint64_t>(kMostInstantNs);
}

/// Nanoseconds in a millisecond.
inline constexpr std::int64_t kNanosecondsPerMillisecond = 1'000'000;

/// To the nearest nanosecond.
inline std::int64_t RoundToNanoseconds(double seconds) { return std::llround(seconds * 1e9); }

/// Nanoseconds as milliseconds.
constexpr double NanosecondsToMilliseconds(std::int64_t nanoseconds) {
  return static_cast<double>(nanoseconds) * 1e-6;
}

/// The length of one period, cut off to nanoseconds; `rate_hz` is positive.
constexpr std::int64_t PeriodNanoseconds(double rate_hz) {
  return static_cast<std::int64_t>(1e9 / rate_hz);
}

}  // namespace footing
