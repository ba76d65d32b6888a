#pragma once

#include <vector>

#include "common/stream/sensor.h"
#include "common/virtual/devices/accelerometer.h"
#include "daemon/sensor/features/rig_features.h"

namespace footing::features {

inline constexpr std::uint32_t kLeft = 11;
inline constexpr std::uint32_t kRight = 12;

RigFeatureExtractor TwoHands();

/// Samples of both hands as footingd would hand them on: filtered, repeats and clipping flagged.
std::vector<stream::MotionSample> Samples(const wrists::HandMotion& motion,
                                          const wrists::SensorModel& model, std::uint64_t seed = 1);

struct Instant {
  double t_s = 0;
  stream::RigFeatures rig;
};

/// The features after every pair of samples.
std::vector<Instant> RunChain(const wrists::HandMotion& motion,
                              const wrists::SensorModel& model = {}, std::uint64_t seed = 1);

/// True when no number of the features is NaN or infinite.
bool AllFinite(const stream::RigFeatures& rig);

}  // namespace footing::features
