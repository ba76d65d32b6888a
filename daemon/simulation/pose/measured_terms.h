#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/body/body.h"
#include "common/body/kinematics.h"
#include "common/body/momentum.h"
#include "daemon/simulation/pose/joint_limits.h"
#include "daemon/simulation/pose/targets.h"

namespace footing::pose {

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
  std::vector<std::vector<int>> limited_dofs_;  ///< Of each block of limits.
  JacobianBlock single_;  ///< Of JointBlock and ComBlock, and of a joint that another is seen from.
  body::Kinematics at_;
  body::CompositeMasses workspace_;
  body::CentroidalMatrix centroidal_;
};

}  // namespace footing::pose
