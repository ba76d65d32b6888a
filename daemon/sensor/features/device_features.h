#pragma once

#include <cstdint>
#include <optional>

#include "common/stream/sensor.h"
#include "daemon/sensor/features/cadence.h"
#include "daemon/sensor/features/config.h"
#include "daemon/sensor/features/cycle.h"
#include "daemon/sensor/features/grip.h"
#include "daemon/sensor/features/moving.h"
#include "daemon/sensor/features/sample_grid.h"

namespace footing::features {

/// The features of one controller. A plain value; copy it to try something out.
class DeviceFeatureExtractor {
 public:
  DeviceFeatureExtractor(std::uint32_t device, stream::DeviceRole role, const Config& config);

  void AddSample(const stream::MotionSample& sample);
  /// Takes the newest samples in: first Observe of all controllers, then Compute of each. Forgets
  /// all when the newest sample is older than Config::stale_s at `now_ns`.
  /// `partner` is what the other hand or leg showed until now.
  void Observe(std::int64_t now_ns, const Partner& partner);
  /// The period as the newest samples alone show it; not found while still.
  const PeriodEstimate& estimate() const { return estimate_; }
  /// The estimate, and the cadence of the last Compute.
  Partner AsPartner() const { return {estimate_, cadence_.valid ? cadence_.period_s : 0}; }
  /// The features as of the newest sample.
  const stream::DeviceFeatures& Compute(const Partner& partner);

  /// Since the motion began.
  const SwingEnd& swing_end() const { return swing_end_; }

  /// As rest shows it, or the newest of two cycles that agree on it; in S, m/s². Else none.
  const std::optional<Eigen::Vector3d>& gravity_mps2() const { return gravity_mps2_; }

  std::uint32_t device() const { return features_.device; }
  stream::DeviceRole role() const { return features_.role; }
  const SampleGrid& grid() const { return grid_; }
  /// Of the newest sample; 0 before the first.
  std::int64_t newest_received_ns() const { return newest_received_ns_; }

 private:
  void MeasureCycle();
  void MeasureRest();
  void Forget();

  Config config_;
  SampleGrid grid_;
  stream::DeviceFeatures features_;
  Moving moving_;
  PeriodEstimate estimate_;
  Cadence cadence_;
  SwingEnd swing_end_;
  std::optional<Eigen::Vector3d> gravity_mps2_;
  double elapsed_s_ = 0;  ///< Between the newest points of the last two Observe; 0 nothing new.
  std::int64_t newest_received_ns_ = 0;
  std::uint32_t beginnings_ = 0;     ///< Of the grid, when last observed.
  std::int64_t computed_index_ = 0;  ///< Grid index of the newest point already taken in.
};

}  // namespace footing::features
