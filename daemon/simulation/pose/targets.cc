#include "daemon/simulation/pose/targets.h"

#include <algorithm>
#include <numeric>

#include <Eigen/Geometry>

#include "common/base/result.h"
#include "common/body/landmarks.h"

namespace footing::pose {

JointLimits::JointLimits(const body::Body& body)
    : lower_rad_(body::LowerLimits(body.skeleton)), upper_rad_(body::UpperLimits(body.skeleton)) {
  using body::Landmark;
  for (const Landmark left :
       {Landmark::kLeftHip, Landmark::kLeftKnee, Landmark::kLeftAnkle, Landmark::kLeftElbow}) {
    for (int side = 0; side < 2; ++side) {
      const body::Joint& joint = body.skeleton.joint(body.landmarks[body::OfSide(left, side)]);
      for (std::size_t i = 0; i < joint.rotations.size(); ++i) {
        dofs_.push_back(joint.first_dof + static_cast<int>(i));
      }
    }
  }
  std::sort(dofs_.begin(), dofs_.end());
  excesses_.reserve(dofs_.size());
}

void JointLimits::Measure(const Eigen::VectorXd& q) {
  excesses_.clear();
  for (const int dof : dofs_) {
    const double inside_rad = std::clamp(q(dof), lower_rad_(dof), upper_rad_(dof));
    if (inside_rad != q(dof)) excesses_.push_back({dof, inside_rad - q(dof)});
  }
}

namespace {

// Limits are those of most people, so they give way. 0.03 and 0.1 made the same poses.
constexpr double kLimitSdRad = 0.1;

/// Degrees of freedom that move the frame of each joint: its own and those of its ancestors.
std::vector<std::vector<int>> DofsThatMove(const body::Skeleton& skeleton) {
  std::vector<std::vector<int>> moved(skeleton.joints.size());
  for (int i = 0; i < skeleton.size(); ++i) {
    std::vector<int>& dofs = moved[static_cast<std::size_t>(i)];
    const body::Joint& joint = skeleton.joint(i);
    dofs = joint.parent < 0 ? std::vector<int>{0, 1, 2}
                            : moved[static_cast<std::size_t>(joint.parent)];
    for (std::size_t k = 0; k < joint.rotations.size(); ++k) {
      dofs.push_back(joint.first_dof + static_cast<int>(k));
    }
  }
  return moved;
}

}  // namespace

MeasuredTerms::MeasuredTerms(const body::Body& body, double frame_s)
    : body_(&body),
      frame_s_(frame_s),
      moved_by_(DofsThatMove(body.skeleton)),
      all_dofs_(static_cast<std::size_t>(body.skeleton.dof)),
      limits_(body),
      residuals_(Eigen::VectorXd::Zero(kMaxRows)),
      rate_(Eigen::VectorXd::Zero(body.skeleton.dof)),
      blocks_(kMaxRows / 3),
      limited_dofs_(kMaxAngles / 3, std::vector<int>(3)),
      at_(body.skeleton),
      workspace_(body.skeleton),
      centroidal_(6, body.skeleton.dof) {
  FOOTING_CHECK(limits_.most() <= kMaxAngles);
  std::iota(all_dofs_.begin(), all_dofs_.end(), 0);
  for (JacobianBlock& block : blocks_) block.by_q.setZero(3, body.skeleton.dof);
  single_.by_q.setZero(3, body.skeleton.dof);
}

void MeasuredTerms::Measure(const PoseTargets& targets, const Eigen::VectorXd& q,
                            const Eigen::VectorXd* q_before) {
  body::ComputeKinematics(body_->skeleton, q, at_);
  has_angular_ = targets.has_angular && q_before != nullptr;
  row_count_ = 0;
  const auto add = [this](const Eigen::Vector3d& residual) {
    residuals_.segment<3>(row_count_) = residual;
    row_count_ += 3;
  };
  for (int i = 0; i < targets.count; ++i) {
    const PointTarget& point = targets.points[static_cast<std::size_t>(i)];
    add(Whitened(point, point.p_W_m - PlaceOf(point, at_)));
  }
  if (has_angular_) {
    com_W_m_ = body::ComputeCentroidalMatrix(*body_, at_, workspace_, centroidal_);
  } else if (targets.has_com) {
    com_W_m_ = body::CentreOfMass(*body_, at_);
  }
  if (targets.has_com) add((targets.com_W_m - com_W_m_).cwiseQuotient(targets.com_sd_m));
  if (has_angular_) {
    rate_ = (q - *q_before) / frame_s_;
    const Eigen::Vector3d angular_W = centroidal_.bottomRows<3>() * rate_;
    add((targets.angular_W - angular_W).cwiseQuotient(targets.angular_sd));
  }
  MeasureLimits(q);
}

void MeasuredTerms::MeasureLimits(const Eigen::VectorXd& q) {
  limits_.Measure(q);
  const std::vector<JointLimits::Excess>& excesses = limits_.excesses();
  for (std::size_t i = 0; i < excesses.size(); i += 3, row_count_ += 3) {
    residuals_.segment<3>(row_count_).setZero();
    for (std::size_t k = 0; k < std::min<std::size_t>(3, excesses.size() - i); ++k) {
      residuals_(row_count_ + static_cast<int>(k)) = excesses[i + k].back_rad / kLimitSdRad;
    }
  }
}

void MeasuredTerms::DifferentiatePoint(const PointTarget& point, JacobianBlock& out) {
  const auto joint = static_cast<std::size_t>(point.joint);
  const Eigen::Vector3d p_W_m = at_.p_WJ[joint] + at_.R_WJ[joint] * point.p_J_m;
  body::PointJacobian(body_->skeleton, at_, point.joint, p_W_m, out.by_q);
  out.dofs = &moved_by_[joint];
  if (point.from_joint >= 0) {
    out.by_q -= JointBlock(point.from_joint).by_q;
    out.dofs = &all_dofs_;
  }
  const Eigen::Matrix3d weight = point.whitening * point.sd_m.cwiseInverse().asDiagonal();
  for (const int dof : *out.dofs) out.by_q.col(dof) = (weight * out.by_q.col(dof)).eval();
}

void MeasuredTerms::Differentiate(const PoseTargets& targets) {
  int row = 0;
  for (int i = 0; i < targets.count; ++i, row += 3) {
    DifferentiatePoint(targets.points[static_cast<std::size_t>(i)], MutableBlock(row));
  }
  if (targets.has_com) {
    JacobianBlock& com = MutableBlock(row);
    com.dofs = &all_dofs_;
    body::ComJacobian(*body_, at_, workspace_, com.by_q);
    com.by_q.array().colwise() /= targets.com_sd_m.array();
    row += 3;
  }
  if (has_angular_) {
    JacobianBlock& angular = MutableBlock(row);
    angular.dofs = &all_dofs_;
    angular.by_q =
        (targets.angular_sd * frame_s_).cwiseInverse().asDiagonal() * centroidal_.bottomRows<3>();
    row += 3;
  }
  DifferentiateLimits(row);
}

void MeasuredTerms::DifferentiateLimits(int row) {
  const std::vector<JointLimits::Excess>& excesses = limits_.excesses();
  for (std::size_t i = 0; i < excesses.size(); i += 3, row += 3) {
    std::vector<int>& dofs = limited_dofs_[i / 3];
    JacobianBlock& block = MutableBlock(row);
    dofs.clear();
    for (std::size_t k = 0; k < std::min<std::size_t>(3, excesses.size() - i); ++k) {
      const int dof = excesses[i + k].dof;
      dofs.push_back(dof);
      block.by_q.col(dof) = Eigen::Vector3d::Unit(static_cast<int>(k)) / kLimitSdRad;
    }
    block.dofs = &dofs;
  }
}

const JacobianBlock& MeasuredTerms::JointBlock(int joint) {
  const auto index = static_cast<std::size_t>(joint);
  body::PointJacobian(body_->skeleton, at_, joint, at_.p_WJ[index], single_.by_q);
  single_.dofs = &moved_by_[index];
  return single_;
}

const JacobianBlock& MeasuredTerms::ComBlock() {
  body::ComJacobian(*body_, at_, workspace_, single_.by_q);
  single_.dofs = &all_dofs_;
  return single_;
}

const JacobianBlock& MeasuredTerms::TurnBlock(int joint, int above,
                                              const Eigen::Matrix3d& to_angles) {
  single_.dofs = &moved_by_[static_cast<std::size_t>(joint)];
  for (const int dof : *single_.dofs) single_.by_q.col(dof).setZero();
  for (int i = joint; i >= 0 && i != above; i = body_->skeleton.joint(i).parent) {
    const body::Joint& link = body_->skeleton.joint(i);
    const int end = link.first_dof + static_cast<int>(link.rotations.size());
    for (int dof = link.first_dof; dof < end; ++dof) {
      single_.by_q.col(dof) = to_angles * at_.axis_W[static_cast<std::size_t>(dof)];
    }
  }
  return single_;
}

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
