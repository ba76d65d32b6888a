#include "common/body/fit.h"

#include <algorithm>
#include <cmath>

#include "common/base/result.h"

namespace footing::body {
namespace {

constexpr double kFirstDamping = 1e-4, kLeastDamping = 1e-9, kMostDamping = 1e6;
constexpr double kLeastDiagonal = 1e-6;
constexpr double kHold = 0.01;  // m/rad.

}  // namespace

PoseFit::PoseFit(const Skeleton& skeleton)
    : skeleton_(skeleton),
      at_(skeleton),
      H_(skeleton.dof, skeleton.dof),
      damped_(skeleton.dof, skeleton.dof),
      gradient_(skeleton.dof),
      hold_(skeleton.dof),
      neutral_(skeleton.dof),
      trial_(skeleton.dof),
      step_(skeleton.dof),
      solver_(skeleton.dof) {}

double PoseFit::PointCost(const std::vector<PointTarget>& targets, const Eigen::VectorXd& q) {
  ComputeKinematics(skeleton_, q, at_);
  double cost = 0;
  for (const PointTarget& target : targets) {
    const auto joint = static_cast<std::size_t>(target.joint);
    const Eigen::Vector3d p_W = at_.p_WJ[joint] + at_.R_WJ[joint] * target.p_J;
    cost += target.weight * (target.p_W - p_W).squaredNorm();
  }
  return cost;
}

void PoseFit::SetHold(const FitOptions& options, const Eigen::Ref<const Eigen::VectorXd>& q) {
  neutral_ = q;
  if (options.neutral != nullptr) neutral_ = *options.neutral;
  hold_.setConstant(kHold * kHold);
  if (options.hold != nullptr) hold_ = options.hold->cwiseAbs2();
  if (options.neutral == nullptr) hold_.head<3>().setZero();
}

double PoseFit::HoldCost(const Eigen::VectorXd& q) const {
  return (q - neutral_).cwiseAbs2().dot(hold_);
}

void PoseFit::Linearise(const std::vector<PointTarget>& targets,
                        const Eigen::Ref<const Eigen::VectorXd>& q) {
  const auto rows = 3 * static_cast<Eigen::Index>(targets.size());
  if (J_.rows() < rows) {
    J_.resize(rows, skeleton_.dof);
    residuals_.resize(rows);
  }
  ComputeKinematics(skeleton_, q, at_);
  Eigen::Index row = 0;
  for (const PointTarget& target : targets) {
    const auto joint = static_cast<std::size_t>(target.joint);
    const double root = std::sqrt(target.weight);
    const Eigen::Vector3d p_W = at_.p_WJ[joint] + at_.R_WJ[joint] * target.p_J;
    PointJacobian(skeleton_, at_, target.joint, p_W, J_.middleRows<3>(row));
    J_.middleRows<3>(row) *= root;
    residuals_.segment<3>(row) = root * (target.p_W - p_W);
    row += 3;
  }
  H_.setZero();
  H_.selfadjointView<Eigen::Lower>().rankUpdate(J_.topRows(rows).transpose());
  H_.diagonal() += hold_;
  gradient_.noalias() = J_.topRows(rows).transpose() * residuals_.head(rows);
  gradient_ -= hold_.cwiseProduct(q - neutral_);
}

bool PoseFit::Step(const std::vector<PointTarget>& targets, Descent& descent,
                   Eigen::Ref<Eigen::VectorXd> q) {
  bool better = false;
  while (!better && descent.damping < kMostDamping) {
    damped_ = H_;
    damped_.diagonal().array() += descent.damping * (H_.diagonal().array() + kLeastDiagonal);
    solver_.compute(damped_);
    step_ = gradient_;
    solver_.solveInPlace(step_);
    trial_ = q + step_;
    const double points = PointCost(targets, trial_);
    descent.gain = descent.cost - points - HoldCost(trial_);
    better = solver_.info() == Eigen::Success && descent.gain >= 0;
    if (better) {
      descent.points = points;
      descent.cost -= descent.gain;
      q = trial_;
    }
    descent.damping = better ? std::max(descent.damping / 10, kLeastDamping) : descent.damping * 10;
  }
  return better;
}

double PoseFit::Fit(const std::vector<PointTarget>& targets, const FitOptions& options,
                    Eigen::Ref<Eigen::VectorXd> q) {
  FOOTING_CHECK(q.size() == skeleton_.dof);
  double weights = 0;
  for (const PointTarget& target : targets) weights += target.weight;
  if (!(weights > 0)) return 0;
  SetHold(options, q);
  trial_ = q;
  Descent descent;
  descent.damping = kFirstDamping;
  descent.points = PointCost(targets, trial_);
  descent.cost = descent.points + HoldCost(trial_);
  for (int i = 0; i < options.iterations; ++i) {
    Linearise(targets, q);
    if (!Step(targets, descent, q) || descent.gain <= options.still * descent.cost) break;
  }
  return std::sqrt(descent.points / weights);
}

}  // namespace footing::body
