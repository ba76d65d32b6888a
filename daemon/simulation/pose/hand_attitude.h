#pragma once

#include <Eigen/Core>

#include "daemon/simulation/pose/attitude_filter.h"

/// Arms from devices with an accelerometer and a gyroscope, in the fists (Ha, Bai & Liu 2011,
/// section 5.2) or strapped on upper arms and forearms; docs/hands.md says where this departs from
/// the paper.
namespace footing::arms {

/// How a device has turned since the T-pose, and what it feels.
struct HandState {
  bool valid = false;
  Eigen::Matrix3d turn_W = Eigen::Matrix3d::Identity();  ///< R_WS(now) R_WS(T-pose)^T.
  Eigen::Vector3d acceleration_W_mps2 = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular_velocity_W_radps = Eigen::Vector3d::Zero();
  /// Standard deviations of the turn about the vertical, which grows, and about a level axis.
  double heading_sd_rad = 0, inclination_sd_rad = 0;
};

/// The attitude of a device on an arm (AttitudeFilter), from a T-pose on, in which its heading is
/// known. How else it is mounted does not matter. A value.
class HandAttitude {
 public:
  HandAttitude() = default;
  /// `heading_rad`: of S's x in the T-pose; 0 is forwards, pi/2 to the left.
  explicit HandAttitude(double heading_rad);

  /// Non-finite readings are left out.
  void Advance(const HandReading& reading, double step_s);
  /// A T-pose begins: the readings so far do not count. Nothing once aligned.
  void BeginTPose();
  /// The T-pose is held and was for some seconds: the mean turn is the gyroscope's bias, the mean
  /// force is up, and S's x has its heading. Without a second of readings, or with S's x upright,
  /// the state stays invalid.
  void Align();
  /// Invalid until aligned.
  const HandState& state() const { return state_; }

 private:
  double rested_s_ = 0;
  Eigen::Vector3d mean_force_S_ = Eigen::Vector3d::Zero(), bias_S_ = Eigen::Vector3d::Zero();
  AttitudeFilter filter_;
  Eigen::Matrix3d R_WF_ = Eigen::Matrix3d::Identity();  ///< F: the filter's world.
  Eigen::Matrix3d R_ST_ = Eigen::Matrix3d::Identity();  ///< R_WS^T of the T-pose.
  HandState state_;
};

}  // namespace footing::arms
