#include "daemon/simulation/pose/gauss_newton.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "common/base/result.h"

namespace footing::pose {
namespace {

constexpr double kLeastVariance = 1e-9;

int Count(const Eigen::VectorXd& falling_variances, double share) {
  const double total = falling_variances.sum();
  double sum = 0;
  int count = 0;
  for (const double variance : falling_variances) {
    if (variance < kLeastVariance || (count > 0 && sum >= share * total)) break;
    sum += variance;
    ++count;
  }
  return std::max(1, count);
}

}  // namespace

PoseBasis FitBasis(const Eigen::Ref<const Eigen::MatrixXd>& poses, const BasisOptions& options) {
  FOOTING_CHECK(poses.cols() >= 2 && poses.rows() > 3);
  PoseBasis basis;
  basis.mean = poses.rowwise().mean();
  Eigen::VectorXd scale = Eigen::VectorXd::Ones(poses.rows());
  scale.head<3>().setConstant(options.translation_weight);
  const Eigen::MatrixXd centred = scale.asDiagonal() * (poses.colwise() - basis.mean);
  const Eigen::MatrixXd covariance =
      centred * centred.transpose() / static_cast<double>(poses.cols());
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(covariance);
  const Eigen::VectorXd variances = solver.eigenvalues().reverse();
  const int count = Count(variances, options.variance_share);
  const Eigen::MatrixXd vectors = solver.eigenvectors().rowwise().reverse().leftCols(count);
  basis.modes = scale.cwiseInverse().asDiagonal() * vectors;
  basis.inverse = vectors.transpose() * scale.asDiagonal();
  basis.sd = variances.head(count).cwiseSqrt();
  return basis;
}

PoseBasis Resized(PoseBasis basis, double scale) {
  basis.mean.head<3>() *= scale;
  basis.modes.topRows<3>() *= scale;
  basis.inverse.leftCols<3>() /= scale;
  return basis;
}

PoseBasis Leading(PoseBasis basis, double share) {
  const double total = basis.sd.squaredNorm();
  Eigen::Index count = 0;
  double sum = 0;
  while (count < basis.sd.size() && sum < share * total) sum += std::pow(basis.sd(count++), 2);
  basis.modes = basis.modes.leftCols(count).eval();
  basis.inverse = basis.inverse.topRows(count).eval();
  basis.sd = basis.sd.head(count).eval();
  return basis;
}

PoseBasis Widened(const PoseBasis& basis, const Eigen::VectorXd& direction) {
  const Eigen::MatrixXd scaled = basis.modes * basis.sd.asDiagonal();
  const Eigen::MatrixXd covariance =
      scaled * scaled.transpose() + direction * direction.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solved(covariance);
  PoseBasis widened = basis;
  // From the largest variance down, as those that a basis has.
  const int size = std::min(basis.size() + 1, basis.dof());
  widened.modes = solved.eigenvectors().rowwise().reverse().leftCols(size);
  widened.inverse = widened.modes.transpose();
  widened.sd = solved.eigenvalues().reverse().head(size).cwiseMax(1e-12).cwiseSqrt();
  return widened;
}

PoseBasis Unconnected(const PoseBasis& basis) {
  PoseBasis single;
  single.mean = basis.mean;
  single.modes = Eigen::MatrixXd::Identity(basis.dof(), basis.dof());
  single.inverse = single.modes;
  single.sd = (basis.modes * basis.sd.asDiagonal()).rowwise().norm().cwiseMax(1e-4);
  return single;
}

namespace {

constexpr int kStrip = 6;  // Numbers that are summed side by side.

constexpr int WholeStrips(int size) { return (size + kStrip - 1) / kStrip * kStrip; }

/// Three rows of a product, kStrip columns of it.
struct ProductStrips {
  using Strip = Eigen::Array<double, kStrip, 1>;
  Strip x, y, z;
};

/// Columns from `column` on of block.by_q m, summed over the block's degrees of freedom in their
/// order.
template <typename Matrix>
ProductStrips Product(const JacobianBlock& block, const Matrix& m, int column) {
  using Strip = ProductStrips::Strip;
  Strip x = Strip::Zero(), y = x, z = x;
  const Eigen::Index stride = m.outerStride();
  const double* const first = m.data() + column;
  const double* const weights = block.by_q.data();
  for (const int dof : *block.dofs) {
    const Strip row = Eigen::Map<const Strip>(first + dof * stride);
    x += weights[3 * dof] * row;
    y += weights[3 * dof + 1] * row;
    z += weights[3 * dof + 2] * row;
  }
  return {x, y, z};
}

/// The first `size` columns of block.by_q m, as three rows of `out` from `row` on.
template <typename Matrix>
void MultiplyInto(const JacobianBlock& block, const Matrix& m, int size, int row, Matrix& out) {
  for (int column = 0; column < size; column += kStrip) {
    const ProductStrips part = Product(block, m, column);
    out.row(row).template segment<kStrip>(column) = part.x.transpose();
    out.row(row + 1).template segment<kStrip>(column) = part.y.transpose();
    out.row(row + 2).template segment<kStrip>(column) = part.z.transpose();
  }
}

}  // namespace

PoseUpdate::PoseUpdate(const PoseBasis& basis)
    : dof_(basis.dof()),
      P_(Rows::Zero(basis.dof(), WholeStrips(basis.dof()))),
      PHt_(Rows::Zero(basis.dof(), WholeStrips(MeasuredTerms::kMaxRows))),
      HPHt_(Rows::Zero(MeasuredTerms::kMaxRows, WholeStrips(MeasuredTerms::kMaxRows))),
      S_(MeasuredTerms::kMaxRows, MeasuredTerms::kMaxRows),
      open_PHt_(3, WholeStrips(basis.dof())),
      open_HPHt_(3, WholeStrips(MeasuredTerms::kMaxRows)),
      innovation_(MeasuredTerms::kMaxRows) {
  P_.leftCols(basis.dof()).noalias() =
      basis.modes * basis.sd.cwiseAbs2().asDiagonal() * basis.modes.transpose();
}

void PoseUpdate::SetTerms(const MeasuredTerms& terms) {
  row_count_ = terms.rows();
  for (int row = 0; row < row_count_; row += 3) {
    for (int dof = 0; dof < dof_; dof += kStrip) {
      const ProductStrips part = Product(terms.block(row), P_, dof);
      for (int i = 0; i < std::min(kStrip, dof_ - dof); ++i) {
        PHt_.row(dof + i).segment<3>(row) << part.x(i), part.y(i), part.z(i);
      }
    }
  }
  for (int row = 0; row < row_count_; row += 3) {
    MultiplyInto(terms.block(row), PHt_, row + 3, row, HPHt_);
  }
}

void PoseUpdate::Factorise(double weight) {
  weight_ = weight;
  Eigen::Ref<Rows> S = S_.topLeftCorner(row_count_, row_count_);
  S = HPHt_.topLeftCorner(row_count_, row_count_) / weight_;
  S.diagonal().array() += 1;
  const Eigen::LLT<Eigen::Ref<Rows>> in_place(S);
}

void PoseUpdate::Correct(const MeasuredTerms& terms, const Eigen::VectorXd& offset,
                         Eigen::VectorXd& q) {
  auto innovation = innovation_.head(row_count_);
  for (int row = 0; row < row_count_; row += 3) {
    const JacobianBlock& block = terms.block(row);
    Eigen::Vector3d sum = terms.residuals().segment<3>(row);
    for (const int dof : *block.dofs) sum += offset(dof) * block.by_q.col(dof);
    innovation.segment<3>(row) = sum;
  }
  const auto factor = S_.topLeftCorner(row_count_, row_count_);
  factor.triangularView<Eigen::Lower>().solveInPlace(innovation);
  factor.transpose().triangularView<Eigen::Upper>().solveInPlace(innovation);
  innovation /= weight_;
  q -= offset;
  q.noalias() += PHt_.leftCols(row_count_) * innovation;
}

Eigen::Vector3d PoseUpdate::OpenVariances(const JacobianBlock& block) {
  MultiplyInto(block, P_, dof_, 0, open_PHt_);
  MultiplyInto(block, PHt_, row_count_, 0, open_HPHt_);
  Eigen::Vector3d open = Eigen::Vector3d::Zero();
  for (const int dof : *block.dofs) {
    open += block.by_q.col(dof).cwiseProduct(open_PHt_.col(dof)) / weight_;
  }
  const auto factor = S_.topLeftCorner(row_count_, row_count_);
  for (int axis = 0; axis < 3; ++axis) {
    auto across = innovation_.head(row_count_);
    across = open_HPHt_.row(axis).head(row_count_).transpose() / weight_;
    factor.triangularView<Eigen::Lower>().solveInPlace(across);
    open(axis) -= across.squaredNorm();
  }
  return open.cwiseMax(0);
}

namespace {

// A start at the likely pose is tried when terms and prior miss by more than their deviations, and
// kept when it is much better: hands by Wiimotes in the fists contradict the rest, and poses of two
// people who were left out were worse with 0.5. Tracked hands have the same poses with 0.1 to 0.5,
// with a doubt of 0.5 to 2, and with 2 to 12 steps.
constexpr double kDoubtPerRow = 1;
constexpr int kSecondIterations = 4;
constexpr double kMuchBetter = 0.1;  // Part of the cost before.

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

Eigen::Vector3d GaussNewton::TurnVariances(int joint, int above, const Eigen::Matrix3d& to_angles) {
  return update_.OpenVariances(terms_.TurnBlock(joint, above, to_angles));
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
  // The difference from the mean is what stays from frame to frame.
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
      a_before_(a_),
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

void FibonacciSearch::Begin() {
  if (!started_) a_.setZero();
  q_before_ = basis_->mean;
  q_before_.noalias() += basis_->modes * a_;
  if (!started_) {
    a_before_ = a_;
    return;
  }
  const double carry = std::pow(options_.carry, 60 * options_.frame_s);
  for (int i = 0; i < basis_->size(); ++i) {
    const double reach = options_.reach * basis_->sd(i);
    const double moved = a_(i) + carry * (a_(i) - a_before_(i));
    a_before_(i) = a_(i);
    a_(i) = std::clamp(moved, -reach, reach);
  }
}

void FibonacciSearch::Solve(const PoseTargets& targets) {
  Begin();
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
  if (!started_) a_before_ = a_;
  started_ = true;
}

}  // namespace footing::pose
