#pragma once

#include <array>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "common/body/body.h"
#include "common/body/kinematics.h"

namespace footing::pose {

/// A point of the body that is known to be somewhere in W, or from the origin of another joint.
struct PointTarget {
  int joint = 0;                                    ///< Joint whose frame it is fixed to.
  Eigen::Vector3d p_J_m = Eigen::Vector3d::Zero();  ///< In that frame.
  Eigen::Vector3d p_W_m = Eigen::Vector3d::Zero();  ///< Where it should be.
  Eigen::Vector3d sd_m = Eigen::Vector3d::Ones();   ///< Along W's axes, positive.
  int from_joint = -1;  ///< p_W_m is the way from there to the point, along W's axes; -1: from W.
  /// Turns errors over sd_m into independent ones of deviation 1 (WhiteningOf). The identity: they
  /// are independent along W's axes.
  Eigen::Matrix3d whitening = Eigen::Matrix3d::Identity();
};

/// The inverse Cholesky factor of the correlations that belong to these covariances of x and y, x
/// and z, y and z. Correlations count for 0.999 of what they are, so that no direction is known
/// exactly; those that no errors can have do not count.
inline Eigen::Matrix3d WhiteningOf(const Eigen::Vector3d& sd_m,
                                   const Eigen::Vector3d& covariance_m2) {
  if (covariance_m2.isZero(0)) return Eigen::Matrix3d::Identity();
  constexpr double kCounts = 0.999;
  Eigen::Matrix3d correlation = Eigen::Matrix3d::Identity();
  const auto set = [&](int i, int j, double value_m2) {
    correlation(i, j) = correlation(j, i) = kCounts * value_m2 / (sd_m(i) * sd_m(j));
  };
  set(0, 1, covariance_m2.x());
  set(0, 2, covariance_m2.y());
  set(1, 2, covariance_m2.z());
  const Eigen::LLT<Eigen::Matrix3d> factor(correlation);
  if (factor.info() != Eigen::Success) return Eigen::Matrix3d::Identity();
  return factor.matrixL().solve(Eigen::Matrix3d::Identity());
}

/// How far the point is off, in independent deviations.
inline Eigen::Vector3d Whitened(const PointTarget& point, const Eigen::Vector3d& off_m) {
  return point.whitening * off_m.cwiseQuotient(point.sd_m);
}

/// Where it is in a pose, in the same terms as p_W_m.
inline Eigen::Vector3d PlaceOf(const PointTarget& point, const body::Kinematics& at) {
  const auto joint = static_cast<std::size_t>(point.joint);
  const Eigen::Vector3d place_m = at.p_WJ[joint] + at.R_WJ[joint] * point.p_J_m;
  if (point.from_joint < 0) return place_m;
  return place_m - at.p_WJ[static_cast<std::size_t>(point.from_joint)];
}

/// Fists or arms (up to 6), ankles and balls (4), the joints of a skeleton (13), and two directions
/// of each worn sensor (18), with one to spare.
inline constexpr int kMaxPoints = 42;

/// Terms that one frame's pose is solved for, those of equation (6), each with its standard
/// deviation. Terms that are not valid are left out.
struct PoseTargets {
  std::array<PointTarget, kMaxPoints> points;
  int count = 0;

  bool has_com = false;
  Eigen::Vector3d com_W_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d com_sd_m = Eigen::Vector3d::Ones();

  bool has_angular = false;                             ///< Needs a pose before.
  Eigen::Vector3d angular_W = Eigen::Vector3d::Zero();  ///< kg m^2/s.
  Eigen::Vector3d angular_sd = Eigen::Vector3d::Ones();

  void Add(const PointTarget& point) {
    if (count < kMaxPoints) points[static_cast<std::size_t>(count++)] = point;
  }
};

/// Angles of hips, knees, ankles and elbows, and which of them a pose has beyond the skeleton's
/// limits. Those of trunk and shoulders are left out: people exceed them, one axis at a time, when
/// they throw or reach up.
///
/// Nothing allocates after the constructor.
class JointLimits {
 public:
  struct Excess {
    int dof = 0;
    double back_rad = 0;  ///< From q to the limit.
  };

  explicit JointLimits(const body::Body& body);

  void Measure(const Eigen::VectorXd& q);
  /// Excesses of the pose measured last, in the order of the degrees of freedom.
  const std::vector<Excess>& excesses() const { return excesses_; }
  /// The most that a pose can have.
  int most() const { return static_cast<int>(dofs_.size()); }

 private:
  std::vector<int> dofs_;
  Eigen::VectorXd lower_rad_, upper_rad_;
  std::vector<Excess> excesses_;
};

/// Derivatives of three residuals by the degrees of freedom `dofs`; columns of others mean nothing.
struct JacobianBlock {
  Eigen::Matrix<double, 3, Eigen::Dynamic> by_q;
  const std::vector<int>* dofs = nullptr;
};

/// The measured terms of equation (6), each divided by its standard deviation: residuals r of a
/// pose and their derivatives H, three rows a point, for the COM and for the angular momentum. A
/// point depends on the degrees of freedom that move its joint, not on the others. Angles beyond
/// the skeleton's limits have a row each, three in a block: how far, over 0.1 rad.
///
/// Nothing allocates after the constructor.
class MeasuredTerms {
 public:
  static constexpr int kMaxAngles = 24;  ///< With limits.
  static constexpr int kMaxRows = 3 * kMaxPoints + 6 + kMaxAngles;

  /// `body` must outlive it. `frame_s`: time between two poses.
  MeasuredTerms(const body::Body& body, double frame_s);

  /// Kinematics and residuals of `q`. Without a pose before, the angular momentum is left out.
  void Measure(const PoseTargets& targets, const Eigen::VectorXd& q,
               const Eigen::VectorXd* q_before);
  /// The blocks of H where Measure was called last.
  void Differentiate(const PoseTargets& targets);

  int rows() const { return row_count_; }
  auto residuals() const { return residuals_.head(row_count_); }
  const JacobianBlock& block(int row) const { return blocks_[static_cast<std::size_t>(row / 3)]; }
  const body::Kinematics& at() const { return at_; }

  /// Where Measure was called last: of a joint's origin, and of the COM. Valid until the next call.
  const JacobianBlock& JointBlock(int joint);
  const JacobianBlock& ComBlock();
  /// The turn of a joint's frame against that of `above`, one of its ancestors (-1: W): the rows
  /// of `to_angles` times the angular velocity in W.
  const JacobianBlock& TurnBlock(int joint, int above, const Eigen::Matrix3d& to_angles);

 private:
  void MeasureLimits(const Eigen::VectorXd& q);
  void DifferentiatePoint(const PointTarget& point, JacobianBlock& out);
  void DifferentiateLimits(int row);
  JacobianBlock& MutableBlock(int row) { return blocks_[static_cast<std::size_t>(row / 3)]; }

  const body::Body* body_;
  double frame_s_;
  std::vector<std::vector<int>> moved_by_;  ///< Degrees of freedom that move each joint.
  std::vector<int> all_dofs_;
  JointLimits limits_;
  int row_count_ = 0;
  bool has_angular_ = false;
  Eigen::VectorXd residuals_, rate_;
  Eigen::Vector3d com_W_m_ = Eigen::Vector3d::Zero();
  std::vector<JacobianBlock> blocks_;
  std::vector<std::vector<int>> limited_dofs_;  ///< Degrees of freedom of each block of limits.
  JacobianBlock single_;  ///< For JointBlock, ComBlock, and a joint that another is seen from.
  body::Kinematics at_;
  body::CompositeMasses workspace_;
  body::CentroidalMatrix centroidal_;
};

/// Foot clean-up (section 6): moves the joints from the hip to the foot, and these alone, so that
/// the points of the foot come to where they should be. Damped least squares.
///
/// Nothing allocates after the constructor.
class LegIk {
 public:
  /// The leg of the joints from `hip` down to `end`, one of its descendants.
  LegIk(const body::Body& body, int hip, int end);

  /// The targets that belong to the leg, all others are left alone. `q` is changed in place, and
  /// so is `at`, where it has the joints.
  void Solve(const PoseTargets& targets, int iterations, Eigen::VectorXd& q, body::Kinematics& at);

 private:
  /// Adds a target to the normal equations.
  void Add(const PointTarget& point, const body::Kinematics& at);

  const body::Body* body_;
  std::vector<int> moved_joints_;  ///< The hip and all that hangs on it.
  std::vector<int> dofs_;          ///< From the hip down to the end,
  std::vector<int> joints_;        ///< and the joint of each.
  Eigen::Matrix<double, 3, Eigen::Dynamic> jacobian_;
  Eigen::MatrixXd normal_;
  Eigen::VectorXd gradient_;
  Eigen::LLT<Eigen::MatrixXd> cholesky_;
};

}  // namespace footing::pose
