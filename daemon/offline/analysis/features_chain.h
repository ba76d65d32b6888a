#pragma once

#include <cstdint>
#include <vector>

#include "common/stream/sensor.h"
#include "common/virtual/devices/accelerometer.h"
#include "daemon/sensor/features/kalman_filter.h"
#include "daemon/sensor/features/rig_features.h"

namespace footing::eval {

inline constexpr std::uint32_t kLeftDevice = 1;
inline constexpr std::uint32_t kRightDevice = 2;

/// The pure chain of footingd behind calibration: filter, then features, of one rig.
class Chain {
 public:
  explicit Chain(const std::vector<features::Member>& members, const features::Config& config = {});
  /// Hands: without a right one the rig has the left one alone.
  explicit Chain(bool with_right, const features::Config& config = {});
  /// A device that is not a member is a bug of the caller.
  void Add(std::uint32_t device, std::int64_t sampled_ns,
           const Eigen::Vector3d& specific_force_mps2, std::uint32_t clipped_axes = 0);
  stream::RigFeatures Compute(std::int64_t now_ns) { return rig_.Compute(now_ns); }

 private:
  struct Last {
    std::uint32_t device = 0;
    bool any = false;
    Eigen::Vector3d specific_force_mps2 = Eigen::Vector3d::Zero();
    signal::KalmanFilter filter;
  };
  std::vector<Last> last_;
  features::RigFeatureExtractor rig_;
};

struct Tick {
  double t_s = 0;
  stream::RigFeatures features;
};

/// Runs synthetic motion through the chain: one tick a reading.
std::vector<Tick> Run(const std::vector<wrists::TimedReading>& readings,
                      const features::Config& config = {});

}  // namespace footing::eval
