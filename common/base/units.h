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

constexpr double DegreesToRadians(double degrees) { return degrees * kPi / 180.0; }
constexpr double RadiansToDegrees(double radians) { return radians * 180.0 / kPi; }

/// Mass shown on a scale to the force behind it, and back.
constexpr double KilogramsToNewtons(double kilograms) { return kilograms * kStandardGravityMps2; }
constexpr double NewtonsToKilograms(double newtons) { return newtons / kStandardGravityMps2; }

constexpr std::int64_t SecondsToNanoseconds(double seconds) {
  return static_cast<std::int64_t>(seconds * 1e9);
}
constexpr double NanosecondsToSeconds(std::int64_t nanoseconds) {
  return static_cast<double>(nanoseconds) * 1e-9;
}

inline double FiniteOrZero(double value) { return std::isfinite(value) ? value : 0; }

/// The same angle in (-pi, pi]. `radians` must be finite.
double WrapAngle(double radians);

}  // namespace footing
