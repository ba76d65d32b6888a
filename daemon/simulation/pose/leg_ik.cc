#include "daemon/simulation/pose/leg_ik.h"

#include <Eigen/Geometry>

#include "common/base/result.h"

namespace footing::pose {
namespace {

constexpr double kDamping = 1e-3;  // m per rad, squared: of the order of (3 cm)^2.

bool Carries(const body::Skeleton& skeleton, int joint, int other) {
  while (other > joint) other = skeleton.joint(other).parent;
  return other == joint;
}

}  // namespace

LegIk::LegIk(const body::Body& body, int hip, int end) : body_(&body) {
  const body::Skeleton& skeleton = body.skeleton;
  FOOTING_CHECK(Carries(skeleton, hip, end));
  for (int joint = hip; joint < skeleton.size(); ++joint) {
    if (!Carries(skeleton, hip, joint)) continue;
    moved_joints_.push_back(joint);
    if (!Carries(skeleton, joint, end)) continue;
    const body::Joint& link = skeleton.joint(joint);
    for (std::size_t i = 0; i < link.rotations.size(); ++i) {
      dofs_.push_back(link.first_dof + static_cast<int>(i));
      joints_.push_back(joint);
    }
  }
  const auto size = static_cast<Eigen::Index>(dofs_.size());
  jacobian_.resize(3, size);
  normal_.resize(size, size);
  gradient_.resize(size);
  // Decomposed already, since a copy of one that is not reads what nobody has written.
  cholesky_.compute(Eigen::MatrixXd::Identity(size, size));
}

void LegIk::Add(const PointTarget& point, const body::Kinematics& at) {
  const Eigen::Vector3d p_W_m = PlaceOf(point, at);
  for (std::size_t i = 0; i < dofs_.size(); ++i) {
    const auto column = static_cast<Eigen::Index>(i);
    if (Carries(body_->skeleton, joints_[i], point.joint)) {
      const Eigen::Vector3d arm_m = p_W_m - at.p_WJ[static_cast<std::size_t>(joints_[i])];
      jacobian_.col(column) = at.axis_W[static_cast<std::size_t>(dofs_[i])].cross(arm_m);
    } else {
      jacobian_.col(column).setZero();
    }
  }
  const Eigen::Vector3d error_m = point.p_W_m - p_W_m;
  for (Eigen::Index row = 0; row < jacobian_.cols(); ++row) {
    gradient_(row) += jacobian_.col(row).dot(error_m);
    for (Eigen::Index column = 0; column <= row; ++column) {
      normal_(row, column) += jacobian_.col(row).dot(jacobian_.col(column));
    }
  }
}

void LegIk::Solve(const PoseTargets& targets, int iterations, Eigen::VectorXd& q,
                  body::Kinematics& at) {
  for (int iteration = 0; iteration < iterations; ++iteration) {
    normal_.setIdentity();
    normal_ *= kDamping;
    gradient_.setZero();
    for (int i = 0; i < targets.count; ++i) {
      const PointTarget& point = targets.points[static_cast<std::size_t>(i)];
      if (Carries(body_->skeleton, moved_joints_.front(), point.joint)) Add(point, at);
    }
    cholesky_.compute(normal_);
    cholesky_.solveInPlace(gradient_);
    for (std::size_t i = 0; i < dofs_.size(); ++i) {
      q(dofs_[i]) += gradient_(static_cast<Eigen::Index>(i));
    }
    body::ComputeKinematics(body_->skeleton, q, moved_joints_, at);
  }
}

}  // namespace footing::pose
