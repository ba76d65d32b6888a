#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include <Eigen/Core>

#include "daemon/sensor/reports/output_report.h"

/// The report of an inertial sensor that is not a HID device, such as a phone or a microcontroller
/// (docs/devices.md, "Any inertial sensor"): samples with the sensor's own times, little-endian.
///
/// | bytes | what |
/// |---|---|
/// | 0 | id, 0x01 |
/// | 1 | flags, see InertialFlag |
/// | 2 | buttons |
/// | 3 | battery, percent; 255: unknown |
/// | 4, 5 | number of the report, rises by one |
/// | 6 to 13 | device time of the newest sample, microseconds since any instant |
/// | 14 | count of samples, 1 to 20 |
/// | 28 each, oldest first | age before that time, microseconds; acceleration x, y, z; rate x, y, z
/// |
///
/// An age is a u32, an acceleration and a rate are floats, m/s² and rad/s. Axes of the sensor: x to
/// the right, y ahead, z out of the face that looks up; of a phone to its right, to its top, out of
/// its screen. A sensor that lies face up at rest has an acceleration of +9.8 along z.
namespace footing::reports {

inline constexpr std::uint8_t kInertialInput = 0x01;
/// To the sensor: id, 1 to vibrate or 0.
inline constexpr std::uint8_t kInertialVibrate = 0x02;
inline constexpr std::size_t kMostInertialSamples = 20;

enum InertialFlag : std::uint8_t {
  kInertialInverted =
      0x01,                 ///< Face up at rest it has -9.8 along z: all accelerations are negated.
  kInertialHasRate = 0x02,  ///< Else the rates have no meaning.
  kInertialDegrees = 0x04,  ///< Rates are in degrees a second.
  /// The sender knows its range, and the next three say where it ends; else the receiver guesses.
  kInertialKnowsEnd = 0x08,
  kInertialEndX = 0x10,  ///< Some acceleration along x is at the end of the range.
  kInertialEndY = 0x20,
  kInertialEndZ = 0x40,
};

/// One sample, in the sensor frame S (x left, y front, z down).
struct InertialSample {
  std::int64_t device_ns = 0;
  Eigen::Vector3d specific_force_S_mps2 = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular_velocity_S_radps = Eigen::Vector3d::Zero();
  std::uint32_t clipped_axes = 0;  ///< Bits 0, 1, 2: x, y, z of the acceleration.
};

struct InertialReport {
  bool has_rate = false;
  bool knows_end = false;  ///< Its samples' clipped_axes are by the sender.
  std::uint8_t buttons = 0;
  double battery_fraction = -1;  ///< 0 to 1; negative: unknown.
  std::uint16_t number = 0;
  std::array<InertialSample, kMostInertialSamples> samples{};  ///< Oldest first.
  std::size_t count = 0;
};

/// Axes of a sensor that does not say where its range ends. Sensors end at 2, 4, 8 or 16 g: what is
/// as large as anything before it and within a few percent of such an end is at it, since a real
/// end is met again and again, and never passed. A plain value.
class RangeEnd {
 public:
  /// Bits 0, 1, 2: x, y, z are at the end.
  std::uint32_t AxesAt(const Eigen::Vector3d& specific_force_mps2);

 private:
  double most_mps2_ = 0;  ///< Along any axis so far.
};

/// None for another id, a length that does not fit the count, ages that do not fall, and values
/// that are not finite or that no sensor measures (beyond 1000 m/s² and 200 rad/s).
std::optional<InertialReport> DecodeInertial(Bytes report);

}  // namespace footing::reports
