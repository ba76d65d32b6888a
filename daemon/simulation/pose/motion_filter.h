#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "common/body/body.h"
#include "common/body/kinematics.h"
#include "common/body/momentum.h"
#include "daemon/simulation/pose/basis.h"
#include "daemon/simulation/pose/targets.h"

namespace footing::pose {

/// How fast the coefficients of a basis change: standard deviations of their first and second
/// derivatives, 1/s and 1/s^2 of the coefficient's unit.
struct BasisRates {
  Eigen::VectorXd first_sd;
  Eigen::VectorXd second_sd;
};

/// What the ground's vertical forces say of the body's dynamics: their sum, and their moments about
/// the level axes through the origin of the poses.
struct GroundLoad {
  bool valid = false;
  double force_n = 0;
  Eigen::Vector2d moment_nm = Eigen::Vector2d::Zero();  ///< Sum of y F and of -x F.
  double force_sd_n = 10;
  double moment_sd_nm = 10;
};

struct MotionFilterOptions {
  double frame_s = 1.0 / 60;
  int iterations = 2;
  /// Of the coefficients' third derivative: how quickly an acceleration is forgotten, over the
  /// frequency second_sd / first_sd.
  double jerk = 1.0;
  double spread = 1.0;  ///< Of the prior's standard deviations.
};

/// The most likely motion given all that was measured so far: an iterated extended Kalman filter
/// over coefficients of a basis with their velocities and accelerations, each a stationary process
/// of third order with the spreads of recorded motion. The vertical forces of the ground enter by
/// inverse dynamics of the whole body,
///   F = m (c'' + g),  M = c x F + L',
/// so neither c nor L is ever integrated by itself, and height is seen through posture.
///
/// Nothing allocates after the constructor.
class MotionFilter {
 public:
  /// `body` and `basis` must outlive it.
  MotionFilter(const body::Body& body, const PoseBasis& basis, const BasisRates& rates,
               const MotionFilterOptions& options);

  /// At rest in this pose, each coordinate known to about `sd` (m, rad).
  void Start(const Eigen::VectorXd& q, double sd);
  /// One frame. Of the targets the points and the centre of mass count.
  void Advance(const PoseTargets& targets, const GroundLoad& load);

  bool started() const { return started_; }
  const Eigen::VectorXd& q() const { return q_; }
  const Eigen::VectorXd& q_dot() const { return q_dot_; }
  /// Of the pose: centre of mass and momentum.
  const body::Momentum& momentum() const { return momentum_; }
  /// Standard deviation of a joint's place, along one axis, m.
  double JointSd(int joint);

 private:
  void MakeTransition(const BasisRates& rates);
  void Predict();
  void Place();
  void Linearise(const PoseTargets& targets, const GroundLoad& load);
  void AddPoint(const PointTarget& point);
  void AddLoad(const GroundLoad& load);
  void Gain();

  const body::Body* body_;
  const PoseBasis* basis_;
  MotionFilterOptions options_;
  Eigen::Index k_;
  bool started_ = false;
  /// Of each coefficient: transition and noise of (a, a', a''), entry (r, c) in column 3 r + c.
  Eigen::MatrixXd transition_, noise_;
  Eigen::VectorXd x_, x_predicted_, x_off_;  ///< a, then a', then a''.
  Eigen::MatrixXd p_, p_half_;
  Eigen::VectorXd q_, q_dot_, q_ddot_;
  body::Kinematics at_;
  body::JointVelocities velocities_;
  body::JointAccelerations accelerations_;
  body::CompositeMasses room_;
  body::CentroidalMatrix centroidal_;
  body::Momentum momentum_;
  Eigen::Matrix<double, 3, Eigen::Dynamic> jacobian_, com_jacobian_, angular_jacobian_;
  Eigen::Index places_ = 0, stills_ = 0, loads_ = 0;  ///< Rows of each sort.
  Eigen::MatrixXd place_rows_, still_rows_, load_rows_, load_acceleration_rows_;
  Eigen::VectorXd place_residuals_, still_residuals_, load_residuals_;
  Eigen::VectorXd residuals_;
  Eigen::MatrixXd cross_, whitened_, innovation_;
  Eigen::MatrixXd joint_room_, joint_cross_;
};

}  // namespace footing::pose
