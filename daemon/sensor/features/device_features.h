#pragma once

#include <cstdint>

#include "common/stream/sensor.h"
#include "daemon/sensor/features/cadence.h"
#include "daemon/sensor/features/config.h"
#include "daemon/sensor/features/moving.h"
#include "daemon/sensor/features/sample_grid.h"

namespace footing::features {

/// The features of one controller. A plain value; copy it to try something out.
class DeviceFeatureExtractor {
 public:
  DeviceFeatureExtractor(std::uint32_t device, stream::DeviceRole role, const Config& config);

  void AddSample(const stream::MotionSample& sample);
  /// The features as of the newest sample; none when that is older than Config::stale_s at
  /// `now_ns`.
  stream::DeviceFeatures Compute(std::int64_t now_ns);

  std::uint32_t device() const { return features_.device; }
  stream::DeviceRole role() const { return features_.role; }
  const SampleGrid& grid() const { return grid_; }
  /// Of the newest sample; 0 before the first.
  std::int64_t newest_received_ns() const { return newest_received_ns_; }

 private:
  void Advance(double elapsed_s);
  void MeasureCycle();
  void MeasureRest();
  void Forget();

  Config config_;
  SampleGrid grid_;
  stream::DeviceFeatures features_;
  Moving moving_;
  Cadence cadence_;
  std::int64_t newest_received_ns_ = 0;
  std::int64_t computed_index_ = 0;  ///< Grid index of the newest point already taken in.
};

}  // namespace footing::features
