#include "daemon/simulation/pose/gauss_newton.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "common/result/result.h"

namespace footing::pose {
namespace {

constexpr int kMaxRows = 3 * kMaxPoints + 6;

/// Degrees of freedom that move the frame of each joint: its own and those of its ancestors.
std::vector<std::vector<int>> MovedBy(const body::Skeleton& skeleton) {
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

GaussNewton::GaussNewton(const body::Body& body, const PoseBasis& basis,
                         const GaussNewtonOptions& options)
    : body_(&body),
      basis_(&basis),
      options_(options),
      modes_(basis.modes),
      moved_by_(MovedBy(body.skeleton)),
      no_mean_(Eigen::VectorXd::Zero(basis.size())),
      mean_before_(no_mean_),
      a_(no_mean_),
      a_before_(no_mean_),
      a_best_(no_mean_),
      q_(basis.mean),
      q_before_(basis.mean),
      step_q_(basis.mean),
      variances_(basis.sd.cwiseAbs2()),
      free_sd_(basis.sd),
      pull_(no_mean_),
      jacobian_(3, basis.dof()),
      rows_(kMaxRows, basis.size()),
      square_(kMaxRows, kMaxRows),
      residuals_(kMaxRows),
      across_(kMaxRows),
      joint_rows_(3, basis.size()),
      joint_across_(kMaxRows, 3),
      com_W_m_(Eigen::Vector3d::Zero()),
      at_(body.skeleton),
      room_(body.skeleton),
      centroidal_(6, basis.dof()) {
  FOOTING_CHECK(body.skeleton.dof == basis.dof());
  FOOTING_CHECK(options.prior_weight > 0 || options.smooth_weight > 0);
}

void GaussNewton::Measure(const PoseTargets& targets) {
  body::ComputeKinematics(body_->skeleton, q_, at_);
  row_count_ = 0;
  const auto add = [this](const Eigen::Vector3d& residual, const Eigen::Vector3d& sd) {
    residuals_.segment<3>(row_count_) = residual.cwiseQuotient(sd);
    row_count_ += 3;
  };
  for (int i = 0; i < targets.count; ++i) {
    const PointTarget& point = targets.points[static_cast<std::size_t>(i)];
    add(point.p_W_m - PlaceOf(point, at_), point.sd_m);
  }
  if (Angular(targets)) {
    com_W_m_ = body::ComputeCentroidalMatrix(*body_, at_, room_, centroidal_);
  } else if (targets.has_com) {
    com_W_m_ = body::CentreOfMass(*body_, at_);
  }
  if (targets.has_com) add(targets.com_W_m - com_W_m_, targets.com_sd_m);
  if (Angular(targets)) {
    step_q_ = (q_ - q_before_) / options_.frame_s;
    const Eigen::Vector3d angular_W = centroidal_.bottomRows<3>() * step_q_;
    add(targets.angular_W - angular_W, targets.angular_sd);
  }
}

/// d(place)/d(coefficients), by the degrees of freedom that move the joint alone.
void GaussNewton::PointRows(const PointTarget& point, int row) {
  const auto joint = static_cast<std::size_t>(point.joint);
  const Eigen::Vector3d p_W_m = at_.p_WJ[joint] + at_.R_WJ[joint] * point.p_J_m;
  body::PointJacobian(body_->skeleton, at_, point.joint, p_W_m, jacobian_);
  for (int k = 0; k < 3; ++k) {
    auto out = rows_.row(row + k);
    out.setZero();
    const double weight = 1 / point.sd_m(k);
    for (const int dof : moved_by_[joint]) {
      out.noalias() += weight * jacobian_(k, dof) * modes_.row(dof);
    }
  }
  if (point.from_joint < 0) return;
  const auto from = static_cast<std::size_t>(point.from_joint);
  body::PointJacobian(body_->skeleton, at_, point.from_joint, at_.p_WJ[from], jacobian_);
  for (int k = 0; k < 3; ++k) {
    for (const int dof : moved_by_[from]) {
      rows_.row(row + k).noalias() -= jacobian_(k, dof) / point.sd_m(k) * modes_.row(dof);
    }
  }
}

void GaussNewton::Differentiate(const PoseTargets& targets) {
  int row = 0;
  for (int i = 0; i < targets.count; ++i, row += 3) {
    PointRows(targets.points[static_cast<std::size_t>(i)], row);
  }
  if (targets.has_com && !Angular(targets)) {
    body::ComputeCentroidalMatrix(*body_, at_, room_, centroidal_);
  }
  if (targets.has_com) {
    jacobian_ =
        (targets.com_sd_m * body_->mass_kg).cwiseInverse().asDiagonal() * centroidal_.topRows<3>();
    rows_.middleRows<3>(row).noalias() = jacobian_ * modes_;
    row += 3;
  }
  if (Angular(targets)) {
    jacobian_ = (targets.angular_sd * options_.frame_s).cwiseInverse().asDiagonal() *
                centroidal_.bottomRows<3>();
    rows_.middleRows<3>(row).noalias() = jacobian_ * modes_;
  }
}

double GaussNewton::Cost(const Eigen::Ref<const Eigen::VectorXd>& prior_mean) const {
  return residuals_.head(row_count_).squaredNorm() +
         prior_ * ((a_ - prior_mean).array().square() / variances_.array()).sum() +
         smooth_ * ((a_ - a_before_).array().square() / variances_.array()).sum();
}

/// With P the covariance that prior and smoothness alone would leave, H the rows and r the
/// residuals, the step is P g - P H' (1 + H P H')^-1 H P g, where g = H' r + the prior's pull.
void GaussNewton::TakeStep(const Eigen::Ref<const Eigen::VectorXd>& prior_mean, double damping) {
  const auto rows = rows_.topRows(row_count_);
  pull_.noalias() = rows.transpose() * residuals_.head(row_count_);
  pull_.array() +=
      (prior_ * (prior_mean - a_) + smooth_ * (a_before_ - a_)).array() / variances_.array();
  Factorise(damping);
  pull_ = pull_.cwiseProduct(free_sd_);
  auto across = across_.head(row_count_);
  across.noalias() = rows * pull_;
  const auto factor = square_.topLeftCorner(row_count_, row_count_);
  factor.triangularView<Eigen::Lower>().solveInPlace(across);
  factor.transpose().triangularView<Eigen::Upper>().solveInPlace(across);
  pull_.noalias() -= rows.transpose() * across;
  a_ += free_sd_.cwiseProduct(pull_);
  PlaceAt(a_);
}

/// rows_ times what is free without them, and the Cholesky factor of 1 + rows rows'.
void GaussNewton::Factorise(double damping) {
  free_sd_ = (variances_ / (prior_ + smooth_ + damping)).cwiseSqrt();
  auto rows = rows_.topRows(row_count_);
  rows = rows * free_sd_.asDiagonal();
  Eigen::Ref<Rows> square = square_.topLeftCorner(row_count_, row_count_);
  square.setIdentity();
  square.selfadjointView<Eigen::Lower>().rankUpdate(rows);
  const Eigen::LLT<Eigen::Ref<Rows>> in_place(square);
}

double GaussNewton::JointSd(int joint) {
  const auto index = static_cast<std::size_t>(joint);
  body::PointJacobian(body_->skeleton, at_, joint, at_.p_WJ[index], jacobian_);
  joint_rows_.setZero();
  for (const int dof : moved_by_[index]) {
    joint_rows_.noalias() += jacobian_.col(dof) * modes_.row(dof);
  }
  return std::sqrt(OpenVariances().sum() / 3);
}

Eigen::Vector3d GaussNewton::ComSd() {
  jacobian_ = centroidal_.topRows<3>() / body_->mass_kg;
  joint_rows_.noalias() = jacobian_ * modes_;
  return OpenVariances().cwiseSqrt();
}

Eigen::Vector3d GaussNewton::OpenVariances() {
  joint_rows_ = joint_rows_ * free_sd_.asDiagonal();
  auto across = joint_across_.topRows(row_count_);
  across.noalias() = rows_.topRows(row_count_) * joint_rows_.transpose();
  square_.topLeftCorner(row_count_, row_count_).triangularView<Eigen::Lower>().solveInPlace(across);
  return (joint_rows_.rowwise().squaredNorm() - across.colwise().squaredNorm().transpose())
      .cwiseMax(0);
}

void GaussNewton::PlaceAt(const Eigen::VectorXd& coefficients) {
  q_ = basis_->mean;
  q_.noalias() += basis_->modes * coefficients;
}

void GaussNewton::ContinueFrom(const Eigen::VectorXd& q) {
  a_.noalias() = basis_->inverse * (q - basis_->mean);
  PlaceAt(a_);
  mean_known_ = false;
  started_ = true;
}

void GaussNewton::Begin(const Eigen::Ref<const Eigen::VectorXd>& prior_mean) {
  if (!started_) {
    a_ = prior_mean;
    PlaceAt(a_);
    mean_known_ = false;
  }
  if (!mean_known_) mean_before_ = prior_mean;
  mean_known_ = true;
  q_before_ = q_;
  // What the mean does not explain is what stays from frame to frame.
  a_ += prior_mean - mean_before_;
  mean_before_ = prior_mean;
  a_before_ = a_best_ = a_;
  PlaceAt(a_);
}

void GaussNewton::Solve(const PoseTargets& targets,
                        const Eigen::Ref<const Eigen::VectorXd>& prior_mean) {
  FOOTING_CHECK(prior_mean.size() == basis_->size());
  Begin(prior_mean);
  smooth_ = started_ ? options_.smooth_weight * options_.smooth_weight : 0;
  prior_ = std::max(options_.prior_weight * options_.prior_weight, 1e-9);
  const int iterations = started_ ? options_.iterations : options_.first_iterations;
  Measure(targets);
  double best = Cost(prior_mean), damping = 0, last_damping = 0;
  for (int iteration = 0; iteration < iterations; ++iteration) {
    Differentiate(targets);
    const double used = damping;
    TakeStep(prior_mean, used);
    Measure(targets);
    const double cost = Cost(prior_mean);
    if (cost <= best) {
      best = cost;
      a_best_ = a_;
      damping = damping < 1 ? 0 : damping / 10;
    } else {
      damping = std::max(10.0, 10 * damping);
      a_ = a_best_;
      PlaceAt(a_);
      Measure(targets);
    }
    last_damping = iteration + 1 < iterations ? 0 : used;
  }
  if (last_damping > 0) {  // What is told of the spread knows of no damping.
    Differentiate(targets);
    Factorise(0);
  }
  started_ = true;
}

}  // namespace footing::pose
