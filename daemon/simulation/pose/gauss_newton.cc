#include "daemon/simulation/pose/gauss_newton.h"

#include <algorithm>
#include <cmath>

#include "common/result/result.h"

namespace footing::pose {
namespace {

constexpr int kMaxRows = 3 * kMaxPoints + 6;

}  // namespace

GaussNewton::GaussNewton(const body::Body& body, const PoseBasis& basis,
                         const GaussNewtonOptions& options)
    : body_(&body),
      basis_(&basis),
      options_(options),
      no_mean_(Eigen::VectorXd::Zero(basis.size())),
      mean_before_(no_mean_),
      a_(no_mean_),
      a_before_(no_mean_),
      a_best_(no_mean_),
      q_(basis.mean),
      q_before_(basis.mean),
      step_q_(basis.mean),
      step_(no_mean_),
      information_(Eigen::MatrixXd::Zero(basis.size(), basis.size())),
      jacobian_(3, basis.dof()),
      rows_(kMaxRows, basis.size()),
      residuals_(kMaxRows),
      spread_(basis.size(), 3),
      at_(body.skeleton),
      room_(body.skeleton),
      centroidal_(6, basis.dof()),
      cholesky_(basis.size()) {
  FOOTING_CHECK(body.skeleton.dof == basis.dof());
}

/// Takes jacobian_ as it stands: d(measured)/dq.
void GaussNewton::AddRows(const Eigen::Vector3d& residual, const Eigen::Vector3d& sd) {
  const Eigen::Vector3d weight = sd.cwiseInverse();
  jacobian_ = weight.asDiagonal() * jacobian_;
  rows_.middleRows<3>(row_count_).noalias() = jacobian_ * basis_->modes;
  residuals_.segment<3>(row_count_) = weight.cwiseProduct(residual);
  row_count_ += 3;
}

void GaussNewton::Linearise(const PoseTargets& targets) {
  body::ComputeKinematics(body_->skeleton, q_, at_);
  row_count_ = 0;
  for (int i = 0; i < targets.count; ++i) {
    const PointTarget& point = targets.points[static_cast<std::size_t>(i)];
    const auto joint = static_cast<std::size_t>(point.joint);
    const Eigen::Vector3d p_W_m = at_.p_WJ[joint] + at_.R_WJ[joint] * point.p_J_m;
    body::PointJacobian(body_->skeleton, at_, point.joint, p_W_m, jacobian_);
    AddRows(point.p_W_m - p_W_m, point.sd_m);
  }
  const bool angular = targets.has_angular && started_;
  if (!targets.has_com && !angular) return;
  const Eigen::Vector3d com_W_m = body::ComputeCentroidalMatrix(*body_, at_, room_, centroidal_);
  if (targets.has_com) {
    jacobian_ = centroidal_.topRows<3>() / body_->mass_kg;
    AddRows(targets.com_W_m - com_W_m, targets.com_sd_m);
  }
  if (angular) {
    jacobian_ = centroidal_.bottomRows<3>() / options_.frame_s;
    step_q_ = q_ - q_before_;
    const Eigen::Vector3d angular_W = jacobian_ * step_q_;
    AddRows(targets.angular_W - angular_W, targets.angular_sd);
  }
}

double GaussNewton::Cost(const Eigen::Ref<const Eigen::VectorXd>& prior_mean) const {
  double cost = residuals_.head(row_count_).squaredNorm();
  for (int i = 0; i < basis_->size(); ++i) {
    const double off = a_(i) - prior_mean(i), moved = a_(i) - a_before_(i);
    cost += (prior_ * off * off + smooth_ * moved * moved) / (basis_->sd(i) * basis_->sd(i));
  }
  return cost;
}

void GaussNewton::TakeStep(const Eigen::Ref<const Eigen::VectorXd>& prior_mean, double damping) {
  const auto rows = rows_.topRows(row_count_);
  information_.setZero();
  information_.selfadjointView<Eigen::Lower>().rankUpdate(rows.transpose());
  step_.noalias() = rows.transpose() * residuals_.head(row_count_);
  for (int i = 0; i < basis_->size(); ++i) {
    const double variance = basis_->sd(i) * basis_->sd(i);
    step_(i) += (prior_ * (prior_mean(i) - a_(i)) + smooth_ * (a_before_(i) - a_(i))) / variance;
    information_(i, i) += (prior_ + smooth_ + damping) / variance;
  }
  cholesky_.compute(information_);
  cholesky_.solveInPlace(step_);
  a_ += step_;
  PlaceAt(a_);
}

double GaussNewton::JointSd(int joint) {
  const auto index = static_cast<std::size_t>(joint);
  body::PointJacobian(body_->skeleton, at_, joint, at_.p_WJ[index], jacobian_);
  spread_.noalias() = basis_->modes.transpose() * jacobian_.transpose();
  cholesky_.matrixL().solveInPlace(spread_);
  return std::sqrt(spread_.squaredNorm() / 3);
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

void GaussNewton::Solve(const PoseTargets& targets,
                        const Eigen::Ref<const Eigen::VectorXd>& prior_mean) {
  FOOTING_CHECK(prior_mean.size() == basis_->size());
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
  a_before_ = a_;
  PlaceAt(a_);
  smooth_ = started_ ? options_.smooth_weight * options_.smooth_weight : 0;
  prior_ = options_.prior_weight * options_.prior_weight;
  const int iterations = started_ ? options_.iterations : options_.first_iterations;
  double best = 0, damping = 0;
  for (int iteration = 0;; ++iteration) {
    Linearise(targets);
    const double cost = Cost(prior_mean);
    if (iteration == 0 || cost <= best) {
      best = cost;
      a_best_ = a_;
      damping = damping < 1 ? 0 : damping / 10;
    } else {
      damping = std::max(10.0, 10 * damping);
      a_ = a_best_;
      PlaceAt(a_);
      if (iteration < iterations) Linearise(targets);
    }
    if (iteration == iterations) break;
    TakeStep(prior_mean, damping);
  }
  started_ = true;
}

}  // namespace footing::pose
