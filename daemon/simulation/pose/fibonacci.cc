#include "daemon/simulation/pose/fibonacci.h"

#include <algorithm>
#include <utility>

#include "common/base/result.h"

namespace footing::pose {
namespace {

double Squared(const Eigen::Vector3d& error, const Eigen::Vector3d& sd) {
  return error.cwiseQuotient(sd).squaredNorm();
}

}  // namespace

FibonacciSearch::FibonacciSearch(const body::Body& body, const PoseBasis& basis,
                                 const FibonacciOptions& options)
    : body_(&body),
      basis_(&basis),
      options_(options),
      a_(Eigen::VectorXd::Zero(basis.size())),
      q_(basis.mean),
      q_before_(basis.mean),
      rate_(Eigen::VectorXd::Zero(basis.dof())),
      without_(basis.mean),
      at_(body.skeleton),
      velocities_(body.skeleton) {
  FOOTING_CHECK(body.skeleton.dof == basis.dof() && options.evaluations >= 2);
}

double FibonacciSearch::Cost(const PoseTargets& targets) {
  body::ComputeKinematics(body_->skeleton, q_, at_);
  double cost = 0;
  for (int i = 0; i < targets.count; ++i) {
    const PointTarget& point = targets.points[static_cast<std::size_t>(i)];
    cost += Whitened(point, point.p_W_m - PlaceOf(point, at_)).squaredNorm();
  }
  if (targets.has_com) {
    cost += Squared(targets.com_W_m - body::CentreOfMass(*body_, at_), targets.com_sd_m);
  }
  if (targets.has_angular && started_) {
    rate_ = (q_ - q_before_) / options_.frame_s;
    body::ComputeVelocities(body_->skeleton, at_, rate_, velocities_);
    const body::Momentum momentum = body::ComputeMomentum(*body_, at_, velocities_);
    cost += Squared(targets.angular_W - momentum.angular_W, targets.angular_sd);
  }
  return cost;
}

double FibonacciSearch::CostAt(const PoseTargets& targets, int component, double value) {
  q_ = without_;
  q_.noalias() += value * basis_->modes.col(component);
  return Cost(targets);
}

/// Kiefer 1953: of the points that n evaluations may try, the shortest bracket that holds the
/// minimum of a function with a single one.
void FibonacciSearch::Search(const PoseTargets& targets, int component, double lower,
                             double upper) {
  without_ = basis_->mean;
  without_.noalias() += basis_->modes * a_;
  without_.noalias() -= a_(component) * basis_->modes.col(component);
  double shorter = 1, longer = 1;
  for (int i = 0; i < options_.evaluations - 1; ++i) {
    shorter = std::exchange(longer, longer + shorter);
  }
  double left = upper - (upper - lower) * shorter / longer;
  double right = lower + (upper - lower) * shorter / longer;
  double left_cost = CostAt(targets, component, left);
  double right_cost = CostAt(targets, component, right);
  for (int i = 2; i < options_.evaluations; ++i) {
    if (left_cost < right_cost) {
      upper = std::exchange(right, left);
      right_cost = left_cost;
      left = lower + (upper - right);
      left_cost = CostAt(targets, component, left);
    } else {
      lower = std::exchange(left, right);
      left_cost = right_cost;
      right = upper - (left - lower);
      right_cost = CostAt(targets, component, right);
    }
  }
  a_(component) = left_cost < right_cost ? left : right;
}

void FibonacciSearch::Solve(const PoseTargets& targets) {
  if (!started_) a_.setZero();
  q_before_ = basis_->mean;
  q_before_.noalias() += basis_->modes * a_;
  const int sweeps = started_ ? options_.sweeps : options_.first_sweeps;
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    for (int i = 0; i < basis_->size(); ++i) {
      const double reach = options_.reach * basis_->sd(i);
      const double span = started_ ? options_.span * basis_->sd(i) : 2 * reach;
      const double lower = std::max(-reach, a_(i) - span);
      const double upper = std::min(reach, a_(i) + span);
      if (lower < upper) Search(targets, i, lower, upper);
    }
  }
  q_ = basis_->mean;
  q_.noalias() += basis_->modes * a_;
  cost_ = Cost(targets);
  started_ = true;
}

}  // namespace footing::pose
