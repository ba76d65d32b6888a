#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <vector>

#include "common/body/body.h"
#include "common/body/kinematics.h"
#include "daemon/simulation/pose/targets.h"

namespace footing::pose {

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
