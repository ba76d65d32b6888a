#include "tests/sensor/features/chain.h"

#include <cmath>

#include "common/base/units.h"
#include "daemon/sensor/features/kalman_filter.h"

namespace footing::features {

RigFeatureExtractor TwoHands() {
  return RigFeatureExtractor(
      "alice", {{kLeft, stream::DeviceRole::kLeftHand}, {kRight, stream::DeviceRole::kRightHand}});
}

std::vector<stream::MotionSample> Samples(const wrists::HandMotion& motion,
                                          const wrists::SensorModel& model, std::uint64_t seed) {
  signal::KalmanFilter left_filter;
  signal::KalmanFilter right_filter;
  std::vector<stream::MotionSample> samples;
  const auto add = [&](std::uint32_t device, const wrists::TimedReading& timed,
                       const wrists::SensorReading& reading, signal::KalmanFilter& filter) {
    stream::MotionSample sample;
    sample.device = device;
    sample.sampled_ns = sample.received_ns = timed.sampled_ns;
    sample.specific_force_mps2 = reading.specific_force_mps2;
    sample.filtered_mps2 = filter.Advance(timed.sampled_ns, reading.specific_force_mps2);
    sample.clipped_axes = reading.clipped_axes;
    sample.repeated = samples.size() >= 2 && samples[samples.size() - 2].specific_force_mps2 ==
                                                 reading.specific_force_mps2;
    samples.push_back(sample);
  };
  for (const auto& timed : Record(motion, model, seed, kNanosecondsPerSecond)) {
    add(kLeft, timed, timed.left, left_filter);
    add(kRight, timed, timed.right, right_filter);
  }
  return samples;
}

std::vector<Instant> RunChain(const wrists::HandMotion& motion, const wrists::SensorModel& model,
                              std::uint64_t seed) {
  RigFeatureExtractor rig = TwoHands();
  std::vector<Instant> instants;
  for (const auto& sample : Samples(motion, model, seed)) {
    rig.AddSample(sample);
    if (sample.device != kRight) continue;
    const double t_s = NanosecondsToSeconds(sample.sampled_ns - kNanosecondsPerSecond);
    instants.push_back({t_s, rig.Compute(sample.sampled_ns)});
  }
  return instants;
}

bool AllFinite(const stream::RigFeatures& rig) {
  for (const auto& device : rig.devices) {
    for (const double value :
         {device.frequency_hz, device.amplitude_mps2, device.roll_rad, device.pitch_rad}) {
      if (!std::isfinite(value)) return false;
    }
  }
  for (const auto& pair : rig.pairs) {
    if (!std::isfinite(pair.phase_rad)) return false;
  }
  return true;
}

}  // namespace footing::features
