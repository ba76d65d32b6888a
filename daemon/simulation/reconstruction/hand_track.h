#pragma once

#include <Eigen/Core>

#include "daemon/simulation/reconstruction/reconstruction.h"

namespace footing::reconstruction {

/// Where a hand is by now, of which a tracker tells late: a Kalman filter of place and velocity
/// along each of W's axes; the velocity is white noise through a first-order lag. What is told
/// counts as if its errors were white; they need not be, so no place is told better than the
/// tracker tells it. A value.
class HandTrack {
 public:
  static constexpr double kFurthestS = 0.3;  ///< Nothing is known of a hand later than that.

  /// The hand's place at `time_s`, which is later than the one before; after a pause or a step back
  /// of kFurthestS it begins anew. Finite; deviations above 0.
  void Add(double time_s, const Eigen::Vector3d& p_W_m, const Eigen::Vector3d& sd_m);
  /// At `time_s`, if not before the last place then at that. Invalid before the first.
  HandInput At(double time_s) const;

 private:
  void Predict(double step_s);

  bool started_ = false;
  double time_s_ = 0;
  Eigen::Array3d p_m_ = Eigen::Array3d::Zero(), v_mps_ = Eigen::Array3d::Zero();
  Eigen::Array3d pp_ = Eigen::Array3d::Zero(), pv_ = Eigen::Array3d::Zero(),
                 vv_ = Eigen::Array3d::Zero();  ///< Their covariance.
  Eigen::Array3d told_variance_ = Eigen::Array3d::Ones();
};

}  // namespace footing::reconstruction
