#include "daemon/sensor/service/chains.h"

#include <vector>

#include "common/base/units.h"

namespace footing::sensor {

void BoardChain::Restart() {
  plate_ = board::Plate(config_);
  displacement_ = tare::Displacement();
  recent_.Clear();
}

void BoardChain::SetTare(const std::optional<board::CornerForces>& tare) {
  if (tare == tare_) return;
  tare_ = tare;
  RestartWatch();
}

void BoardChain::Take(const board::CornerForces& measured, stream::BoardSample& sample) {
  recent_.Add({sample.received_ns, {sample.sampled_ns, measured}});
  const board::CornerForces forces = tare_ ? measured - *tare_ : measured;
  const board::PlateReading reading = plate_.Advance(forces);
  sample.top_left_n = forces.top_left_n;
  sample.top_right_n = forces.top_right_n;
  sample.bottom_left_n = forces.bottom_left_n;
  sample.bottom_right_n = forces.bottom_right_n;
  sample.total_n = reading.total_n;
  sample.cop_valid = reading.cop_valid;
  sample.cop_x_m = reading.cop_x_m;
  sample.cop_y_m = reading.cop_y_m;
  sample.contact = reading.contact;
  sample.repeated = reading.repeated;
  sample.tared = tared();
  if (tare_) displacement_.Advance(sample.sampled_ns, forces);
}

tare::Tare BoardChain::SolveTare(std::int64_t now_ns, double window_s) const {
  const std::int64_t from_ns = now_ns - SecondsToNanoseconds(window_s);
  std::vector<tare::TareSample> samples;
  for (const Measured& measured : recent_.samples()) {
    if (measured.received_ns > from_ns) samples.push_back(measured.sample);
  }
  return tare::SolveTare(samples, window_s);
}

void MotionChain::Take(stream::MotionSample& sample, bool measured) {
  if (measured) filtered_mps2_ = filter_.Advance(sample.sampled_ns, sample.specific_force_mps2);
  sample.filtered_mps2 = filtered_mps2_;
  if (!sample.has_angular_velocity) return;
  gyroscope_bias_.Take(sample.sampled_ns, sample.specific_force_mps2,
                       sample.angular_velocity_radps);
  sample.gyroscope_bias_radps = gyroscope_bias_.bias_radps();
  sample.angular_velocity_radps -= sample.gyroscope_bias_radps;
}

void MountedSensor::SetMounting(const std::optional<Eigen::Quaterniond>& rotation_MS,
                                stream::DeviceRole role) {
  rotation_MS_ = rotation_MS;
  slip_ = mounting::SlipWatch(role);
}

stream::MotionSample MountedSensor::Take(const stream::MotionSample& sample_S) {
  recent_.Add(sample_S);
  if (!rotation_MS_) return sample_S;
  const stream::MotionSample sample_M = mounting::Rotated(*rotation_MS_, sample_S);
  slip_.Advance(sample_M);
  return sample_M;
}

mounting::Mounting MountedSensor::Solve(stream::DeviceRole role,
                                        const MountingStretches& stretches) const {
  const auto between = [this](std::int64_t from_ns, std::int64_t to_ns) {
    std::vector<stream::MotionSample> samples;
    for (const stream::MotionSample& sample : recent_.samples()) {
      if (sample.sampled_ns >= from_ns && sample.sampled_ns <= to_ns) samples.push_back(sample);
    }
    return samples;
  };
  const auto still = between(stretches.still_from_ns, stretches.still_to_ns);
  const auto steps = between(stretches.steps_from_ns, stretches.steps_to_ns);
  return mounting::SolveMounting(role, still, steps);
}

}  // namespace footing::sensor
