#pragma once

#include <Eigen/Core>

#include "daemon/simulation/arms/attitude_filter.h"

/// Arms from a device with an accelerometer and a gyroscope in each fist (Ha, Bai & Liu 2011,
/// section 5.2; docs/hands.md says where this departs from it).
namespace footing::arms {

/// How a hand has turned since the T-pose, and what it feels.
struct HandState {
  bool valid = false;
  Eigen::Matrix3d turn_W = Eigen::Matrix3d::Identity();  ///< R_WS(now) R_WS(T-pose)^T.
  Eigen::Vector3d acceleration_W_mps2 = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular_velocity_W_radps = Eigen::Vector3d::Zero();
};

/// The attitude of a device in a fist (AttitudeFilter), from a T-pose on, whose heading it has. A
/// value.
class HandAttitude {
 public:
  /// Non-finite readings are left out.
  void Advance(const HandReading& reading, double step_s);
  /// A T-pose begins: the readings so far do not count. Nothing once aligned.
  void BeginTPose();
  /// The T-pose is held and was for some seconds: the mean turn is the gyroscope's bias, the mean
  /// force is up, and S's x points forward. Without a second of readings the state stays
  /// invalid.
  void Align();
  /// Invalid until aligned.
  const HandState& state() const { return state_; }

 private:
  double rested_s_ = 0;
  Eigen::Vector3d mean_force_S_ = Eigen::Vector3d::Zero(), bias_S_ = Eigen::Vector3d::Zero();
  AttitudeFilter filter_;
  Eigen::Matrix3d R_ST_ = Eigen::Matrix3d::Identity();  ///< R_WS^T of the T-pose.
  HandState state_;
};

}  // namespace footing::arms
