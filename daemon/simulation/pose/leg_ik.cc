#include "daemon/simulation/pose/leg_ik.h"

#include <algorithm>

#include "common/result/result.h"

namespace footing::pose {
namespace {

constexpr double kDamping = 1e-3;  // m per rad, squared: of the order of (3 cm)^2.

int Dofs(const body::Skeleton& skeleton, int hip, int end) {
  int count = 0;
  for (int joint = end;; joint = skeleton.joint(joint).parent) {
    FOOTING_CHECK(joint >= 0);
    count += static_cast<int>(skeleton.joint(joint).rotations.size());
    if (joint == hip) return count;
  }
}

}  // namespace

LegIk::LegIk(const body::Body& body, int hip, int end)
    : body_(&body),
      at_(body.skeleton),
      jacobian_(3, body.skeleton.dof),
      normal_(Dofs(body.skeleton, hip, end), Dofs(body.skeleton, hip, end)),
      gradient_(normal_.rows()),
      // Decomposed already, since a copy of one that is not reads what nobody has written.
      cholesky_(Eigen::MatrixXd::Identity(normal_.rows(), normal_.rows())) {
  for (int joint = end;; joint = body.skeleton.joint(joint).parent) {
    joints_.push_back(joint);
    const body::Joint& link = body.skeleton.joint(joint);
    for (std::size_t i = 0; i < link.rotations.size(); ++i) {
      dofs_.push_back(link.first_dof + static_cast<int>(i));
    }
    if (joint == hip) break;
  }
}

bool LegIk::Has(int joint) const {
  return std::find(joints_.begin(), joints_.end(), joint) != joints_.end();
}

void LegIk::Solve(const PoseTargets& targets, int iterations, Eigen::Ref<Eigen::VectorXd> q) {
  for (int iteration = 0; iteration < iterations; ++iteration) {
    body::ComputeKinematics(body_->skeleton, q, at_);
    normal_.setIdentity();
    normal_ *= kDamping;
    gradient_.setZero();
    for (int i = 0; i < targets.count; ++i) {
      const PointTarget& point = targets.points[static_cast<std::size_t>(i)];
      if (!Has(point.joint)) continue;
      const auto joint = static_cast<std::size_t>(point.joint);
      const Eigen::Vector3d p_W_m = at_.p_WJ[joint] + at_.R_WJ[joint] * point.p_J_m;
      body::PointJacobian(body_->skeleton, at_, point.joint, p_W_m, jacobian_);
      const Eigen::Vector3d error_m = point.p_W_m - p_W_m;
      for (std::size_t r = 0; r < dofs_.size(); ++r) {
        const auto row = static_cast<Eigen::Index>(r);
        gradient_(row) += jacobian_.col(dofs_[r]).dot(error_m);
        for (std::size_t c = 0; c <= r; ++c) {
          normal_(row, static_cast<Eigen::Index>(c)) +=
              jacobian_.col(dofs_[r]).dot(jacobian_.col(dofs_[c]));
        }
      }
    }
    cholesky_.compute(normal_);
    cholesky_.solveInPlace(gradient_);
    for (std::size_t i = 0; i < dofs_.size(); ++i)
      q(dofs_[i]) += gradient_(static_cast<Eigen::Index>(i));
  }
}

}  // namespace footing::pose
