#include "common/virtual/devices/accelerometer.h"

#include <algorithm>
#include <cmath>

#include "common/base/units.h"

namespace footing::wrists {

SensorReading Read(const SensorModel& model, const Eigen::Vector3d& true_mps2,
                   noise::Random& random) {
  SensorReading reading;
  // The last whole count inside the range, so that a clipped value is one the device can send.
  const double end = model.quantum_mps2 > 0
                         ? std::floor(model.range_mps2 / model.quantum_mps2) * model.quantum_mps2
                         : model.range_mps2;
  for (int axis = 0; axis < 3; ++axis) {
    double value = true_mps2(axis) + model.noise_mps2 * random.Normal();
    if (model.quantum_mps2 > 0) {
      value = std::floor(value / model.quantum_mps2 + 0.5) * model.quantum_mps2;
    }
    if (std::abs(value) >= end) {
      value = std::clamp(value, -end, end);
      reading.clipped_axes |= 1u << axis;
    }
    reading.specific_force_mps2(axis) = value;
  }
  return reading;
}

std::vector<TimedReading> Record(const HandMotion& motion, const SensorModel& model,
                                 std::uint64_t seed, std::int64_t start_ns) {
  noise::Random random(seed);
  const auto count = static_cast<std::size_t>(motion.DurationSeconds() * model.rate_hz);
  std::vector<TimedReading> readings;
  readings.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double off_s = model.jitter_s * random.Uniform(-1, 1);
    const double t_s = std::max(0.0, static_cast<double>(i) / model.rate_hz + off_s);
    const Hands hands = motion.At(t_s);
    TimedReading reading;
    reading.sampled_ns = start_ns + SecondsToNanoseconds(t_s);
    reading.left = Read(model, hands.left_mps2, random);
    reading.right = Read(model, hands.right_mps2, random);
    readings.push_back(reading);
  }
  return readings;
}

}  // namespace footing::wrists
