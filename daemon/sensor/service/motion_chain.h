#pragma once

#include <Eigen/Core>

#include "common/stream/sensor.h"
#include "daemon/sensor/reports/gyroscope_bias.h"
#include "daemon/sensor/features/kalman_filter.h"

namespace footing::sensor {

/// A device's motion samples from the measured ones to the published ones: the filtered
/// acceleration beside the raw one, and the gyroscope's bias subtracted. A plain value.
class MotionChain {
 public:
  /// Fills in what is filtered; `measured`: not a repeat with other buttons.
  void Take(stream::MotionSample& sample, bool measured);

 private:
  signal::KalmanFilter filter_;
  calibration::GyroscopeBias gyroscope_bias_;
  Eigen::Vector3d filtered_mps2_ = Eigen::Vector3d::Zero();
};

}  // namespace footing::sensor
