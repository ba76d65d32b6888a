#include "daemon/sensor/service/mounted_sensor.h"

#include <vector>

namespace footing::sensor {

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
