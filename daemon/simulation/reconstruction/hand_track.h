#pragma once

#include <Eigen/Core>
#include <array>

#include "common/stream/hands.h"
#include "daemon/simulation/reconstruction/inputs.h"

namespace footing::reconstruction {

/// Where a hand, or another point of the body, is by now, which a tracker measures with a delay: a
/// Kalman filter of place and velocity along each of W's axes; the velocity is white noise through
/// a first-order lag. Measurements count as if their errors were white; they need not be, so no
/// place is reported with a smaller deviation than the tracker's. A value.
class HandTrack {
 public:
  static constexpr double kFurthestS = 0.3;  ///< Nothing is known of a hand later than that.

  HandTrack() = default;
  /// Of a point that is slower than hands are, by such a part of their speed.
  explicit HandTrack(double speed_share) : speed_share_(speed_share) {}

  /// The hand's place at `time_s`, which is later than the one before; after a pause or a step back
  /// of kFurthestS it starts again. Finite; deviations above 0.
  void Add(double time_s, const Eigen::Vector3d& p_W_m, const Eigen::Vector3d& sd_m,
           const Eigen::Vector3d& covariance_m2 = Eigen::Vector3d::Zero());
  /// At `time_s`, if not before the last place then at that. Invalid before the first.
  HandInput At(double time_s) const;

 private:
  void Predict(double step_s);

  double speed_share_ = 1;
  bool started_ = false;
  double time_s_ = 0;
  Eigen::Array3d p_m_ = Eigen::Array3d::Zero(), v_mps_ = Eigen::Array3d::Zero();
  Eigen::Array3d pp_ = Eigen::Array3d::Zero(), pv_ = Eigen::Array3d::Zero(),
                 vv_ = Eigen::Array3d::Zero();  ///< Their covariance.
  Eigen::Array3d measured_variance_ = Eigen::Array3d::Ones();
  Eigen::Vector3d covariance_m2_ = Eigen::Vector3d::Zero();  ///< Between axes, of the last place.
};

/// Of the joints of a skeleton, by body::IndexOf, which are slower than hands.
std::array<HandTrack, stream::kBodyJoints> JointTracks();

}  // namespace footing::reconstruction
