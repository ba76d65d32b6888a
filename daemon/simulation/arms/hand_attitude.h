#pragma once

#include <Eigen/Core>

/// Arms from a device with an accelerometer and a gyroscope in each fist (Ha, Bai & Liu 2011,
/// section 5.2; docs/hands.md says where this departs from it).
namespace footing::arms {

/// One sample of a device in the fist, in its own frame S.
struct HandReading {
  Eigen::Vector3d specific_force_S_mps2 = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular_velocity_S_radps = Eigen::Vector3d::Zero();
  bool clipped = false;  ///< The accelerometer was at the end of its range.
};

/// How a hand has turned since the T-pose, and what it feels.
struct HandState {
  bool valid = false;
  Eigen::Matrix3d turn_W = Eigen::Matrix3d::Identity();  ///< R_WS(now) R_WS(T-pose)^T.
  Eigen::Vector3d acceleration_W_mps2 = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular_velocity_W_radps = Eigen::Vector3d::Zero();
};

/// Orientation from gyroscope and accelerometer (the six-axis core of VQF: Laidig & Seel,
/// "VQF: highly accurate IMU orientation estimation", Information Fusion 91, 2023): the specific
/// force is low-passed in the frame that the gyroscope alone keeps, where gravity stands still and
/// accelerations cancel out. Without a magnetometer the heading is that of the T-pose and drifts.
/// A clipped accelerometer has no such mean: from then on gravity stays where it was for a while.
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
  void Correct(const HandReading& reading, double step_s);

  double rested_s_ = 0;
  Eigen::Vector3d mean_force_S_ = Eigen::Vector3d::Zero(), bias_S_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d R_GS_ = Eigen::Matrix3d::Identity();  ///< G: kept by the gyroscope alone.
  Eigen::Matrix3d R_WG_ = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d R_ST_ = Eigen::Matrix3d::Identity();  ///< R_WS^T of the T-pose.
  Eigen::Vector3d slow_G_ = Eigen::Vector3d::Zero(), up_G_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d last_turn_S_ = Eigen::Vector3d::Zero();
  double held_s_ = 0;
  HandState state_;
};

}  // namespace footing::arms
