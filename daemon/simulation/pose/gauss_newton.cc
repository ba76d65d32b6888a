#include "daemon/simulation/pose/gauss_newton.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/base/result.h"

namespace footing::pose {
namespace {

// A start at the likely pose is tried when terms and prior miss by more than their deviations, and
// kept when it is much better: hands by Wiimotes in the fists contradict the rest, and poses of two
// people who were left out were worse with 0.5. Tracked hands have the same poses with 0.1 to 0.5,
// with a doubt of 0.5 to 2, and with 2 to 12 steps.
constexpr double kDoubtPerRow = 1;
constexpr int kSecondIterations = 4;
constexpr double kMuchBetter = 0.1;  // Of the cost.

}  // namespace

GaussNewton::GaussNewton(const body::Body& body, const PoseBasis& basis,
                         const GaussNewtonOptions& options)
    : basis_(&basis),
      options_(options),
      terms_(body, options.frame_s),
      update_(basis),
      whitening_(basis.sd.cwiseInverse().asDiagonal() * basis.inverse),
      q_(basis.mean),
      q_before_(basis.mean),
      q_best_(basis.mean),
      q_last_(basis.mean),
      mean_before_(basis.mean),
      centre_(basis.mean),
      offset_q_(basis.mean),
      whitened_(basis.sd) {
  FOOTING_CHECK(body.skeleton.dof == basis.dof());
  FOOTING_CHECK(options.prior_weight > 0 || options.smooth_weight > 0);
}

void GaussNewton::Measure(const PoseTargets& targets) {
  terms_.Measure(targets, q_, started_ ? &q_before_ : nullptr);
}

void GaussNewton::Differentiate(const PoseTargets& targets) {
  terms_.Differentiate(targets);
  update_.SetTerms(terms_);
}

/// The terms of the coefficients about the mean and the start are one about the centre and a
/// constant.
double GaussNewton::Cost() {
  offset_q_ = q_ - centre_;
  whitened_.noalias() = whitening_ * offset_q_;
  return terms_.residuals().squaredNorm() + (prior_ + smooth_) * whitened_.squaredNorm();
}

/// Damping holds to q itself, so it makes the prior's covariance smaller and draws its centre
/// there.
void GaussNewton::TakeStep(double damping) {
  const double weight = prior_ + smooth_ + damping;
  update_.Factorise(weight);
  offset_q_ = (q_ - centre_) * ((weight - damping) / weight);
  update_.Correct(terms_, offset_q_, q_);
}

double GaussNewton::JointSd(int joint) {
  return std::sqrt(update_.OpenVariances(terms_.JointBlock(joint)).sum() / 3);
}

Eigen::Vector3d GaussNewton::ComSd() {
  return update_.OpenVariances(terms_.ComBlock()).cwiseSqrt();
}

void GaussNewton::ContinueFrom(const Eigen::VectorXd& q) {
  offset_q_ = q - basis_->mean;
  whitened_.noalias() = basis_->inverse * offset_q_;
  q_ = basis_->mean;
  q_.noalias() += basis_->modes * whitened_;
  mean_known_ = false;
  started_ = true;
}

void GaussNewton::Start(const Eigen::VectorXd& likely_q) {
  prior_ = std::max(options_.prior_weight * options_.prior_weight, 1e-9);
  smooth_ = started_ ? options_.smooth_weight * options_.smooth_weight : 0;
  if (!started_) {
    q_ = likely_q;
    mean_known_ = false;
  }
  if (!mean_known_) mean_before_ = likely_q;
  mean_known_ = true;
  q_before_ = q_;
  // What the mean does not explain is what stays from frame to frame.
  q_ += likely_q - mean_before_;
  mean_before_ = likely_q;
  centre_ = (prior_ * likely_q + smooth_ * q_) / (prior_ + smooth_);
}

double GaussNewton::Descend(const PoseTargets& targets, int iterations) {
  q_best_ = q_;
  Measure(targets);
  double best = Cost(), damping = 0, last_damping = 0;
  for (int iteration = 0; iteration < iterations; ++iteration) {
    Differentiate(targets);
    const double used = damping;
    TakeStep(used);
    Measure(targets);
    const double cost = Cost();
    if (cost <= best) {
      best = cost;
      q_best_ = q_;
      damping = damping < 1 ? 0 : damping / 10;
    } else {
      damping = std::max(10.0, 10 * damping);
      q_ = q_best_;
      Measure(targets);
    }
    last_damping = iteration + 1 < iterations ? 0 : used;
  }
  if (last_damping > 0) Linearise(targets);
  return best;
}

void GaussNewton::Linearise(const PoseTargets& targets) {
  Differentiate(targets);
  update_.Factorise(prior_ + smooth_);
}

void GaussNewton::DescendFromLikely(const PoseTargets& targets, const Eigen::VectorXd& likely_q) {
  // Both starts are compared without what ties them to the last frame.
  const double smooth = std::exchange(smooth_, 0);
  centre_ = likely_q;
  const double cost = Cost();
  if (cost <= kDoubtPerRow * terms_.rows()) return;
  q_last_ = q_;
  q_ = likely_q;
  if (Descend(targets, kSecondIterations) < kMuchBetter * cost) return;
  q_ = q_last_;
  smooth_ = smooth;
  Measure(targets);
  Linearise(targets);
}

void GaussNewton::Solve(const PoseTargets& targets, const Eigen::VectorXd& likely_q) {
  FOOTING_CHECK(likely_q.size() == basis_->dof());
  const bool first = !started_;
  Start(likely_q);
  Descend(targets, first ? options_.first_iterations : options_.iterations);
  // An angular momentum is measured from the last frame's pose: no jump could agree with it.
  if (!first && targets.count > 0 && !targets.has_angular) DescendFromLikely(targets, likely_q);
  started_ = true;
}

}  // namespace footing::pose
