#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "common/virtual/devices/random.h"
#include "common/virtual/devices/hand_motion.h"

namespace footing::wrists {

/// The errors of one accelerometer and the clock that reads it. SI units.
struct SensorModel {
  double rate_hz = 100;
  /// Reading instants are off by up to this, evenly, either way; keep it below half a period.
  double jitter_s = 0;
  double noise_mps2 = 0.0304;  ///< rms an axis; ADXL330, 3.1 mg.
  double quantum_mps2 =
      0.373;                  ///< One count; 38 mg of the 8-bit reports, 0.092 of 10 bits, 0 none.
  double range_mps2 = 29.42;  ///< Clips beyond +- this (3 g, the sensor's own range).
};

struct SensorReading {
  Eigen::Vector3d specific_force_mps2 = Eigen::Vector3d::Zero();
  std::uint32_t clipped_axes = 0;  ///< Bits 0, 1, 2: x, y, z.
};

/// What the sensor makes of a true specific force: noise, then counts, then the end of the range.
SensorReading Read(const SensorModel& model, const Eigen::Vector3d& true_mps2,
                   noise::Random& random);

struct TimedReading {
  std::int64_t sampled_ns = 0;
  SensorReading left;
  SensorReading right;
};

/// The motion as both sensors record it, from 0 to its end (`start_ns` is added to every stamp).
std::vector<TimedReading> Record(const HandMotion& motion, const SensorModel& model,
                                 std::uint64_t seed, std::int64_t start_ns = 0);

}  // namespace footing::wrists
