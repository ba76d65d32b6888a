#pragma once

#include <Eigen/Core>

#include "daemon/simulation/pose/hand_attitude.h"

namespace footing::inertial {

/// An error-state Kalman filter of a device in the hand: where it is and how fast, its attitude and
/// the biases of its sensors, from what it measures itself and from where a tracker sees a point
/// that is fixed to it. A value; no allocation.
///
/// Frames: S is the device's, W the world's (z up). G is a frame that the gyroscope keeps, upright
/// like W but of any heading. The cosine and the sine of G's heading in W are two states of their
/// own: the acceleration in W is linear in them, so that a heading of which nothing is known (both
/// 0, variance 1/2) is as good a start as any, and motion that is seen determines it.
///
/// Errors by index: place and velocity in W, m and m/s; tilt of G about its x and y, rad; cosine
/// and sine; bias of the gyroscope in S, rad/s; bias of the accelerometer in S, m/s^2.
class Filter {
 public:
  static constexpr int kErrors = 16;
  using Covariance = Eigen::Matrix<double, kErrors, kErrors>;

  /// Where a tracker saw the point, with its covariance.
  struct Observation {
    Eigen::Vector3d p_W_m = Eigen::Vector3d::Zero();
    Eigen::Matrix3d covariance_m2 = Eigen::Matrix3d::Identity();
  };

  /// `p_SP_m`: of the point that is tracked, from the device's accelerometer.
  explicit Filter(const Eigen::Vector3d& p_SP_m = Eigen::Vector3d::Zero()) : p_SP_m_(p_SP_m) {}

  /// At the first observation; with this attitude, whose tilt has this deviation, rad.
  void Start(const Observation& seen, const Eigen::Matrix3d& R_GS, double tilt_sd_rad);

  /// Trust in the readings of a step.
  enum class Trust {
    kMeasured,
    kHeld,     ///< There is none yet at its end: that of its start is held.
    kClipped,  ///< A sensor was at the end of its range.
  };
  /// From one reading to the next, `step_s` later.
  void Advance(const arms::HandReading& from, const arms::HandReading& to, double step_s,
               Trust trust);

  /// Squared Mahalanobis distance of an observation, of three degrees of freedom.
  double Distance(const Observation& seen) const;
  void Update(const Observation& seen);
  /// Finite and not faster than hands: otherwise it has lost its way, and must start again.
  bool IsPlausible() const;
  /// The heading is determined, as a unit vector.
  bool KnowsHeading() const;

  const Eigen::Vector3d& p_W_m() const { return p_W_m_; }  ///< Position of the device.
  const Eigen::Vector3d& v_W_mps() const { return v_W_mps_; }
  /// Standard deviation of G's heading in W; at most pi, when nothing is known of it.
  double heading_sd_rad() const;
  const Covariance& covariance() const { return covariance_; }

 private:
  using Rows = Eigen::Matrix<double, 3, kErrors>;

  Eigen::Matrix3d HeadingMatrix() const;
  /// A vector of G in W, and by the errors of tilt and heading.
  Eigen::Vector3d InWorld(const Eigen::Vector3d& v_G, Rows& by_errors) const;
  Rows Sensitivity(Eigen::Vector3d& p_WP_m) const;
  Eigen::Matrix3d Uncertainty(const Observation& seen) const;
  void AddNoise(const arms::HandReading& reading, const Eigen::Vector3d& force_G_mps2,
                double step_s, Trust trust);

  Eigen::Vector3d p_SP_m_;
  Eigen::Vector3d p_W_m_ = Eigen::Vector3d::Zero(), v_W_mps_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d R_GS_ = Eigen::Matrix3d::Identity();
  Eigen::Vector2d heading_ = Eigen::Vector2d::Zero();  ///< Cosine and sine.
  Eigen::Vector3d turn_bias_S_radps_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d force_bias_S_mps2_ = Eigen::Vector3d::Zero();
  Covariance covariance_ = Covariance::Identity();
};

}  // namespace footing::inertial
