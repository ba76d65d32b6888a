#include "daemon/simulation/pose/gauss_newton.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "common/result/result.h"

namespace footing::pose {
namespace {

constexpr int kStrip = 6;  // Numbers that are summed side by side.
constexpr int kMaxRows = 3 * kMaxPoints + 6;

constexpr int WholeStrips(int size) { return (size + kStrip - 1) / kStrip * kStrip; }

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

/// Three rows of a product, kStrip columns of it.
struct Strips {
  using Strip = Eigen::Array<double, kStrip, 1>;
  Strip x, y, z;
};

/// Columns from `column` on of by_q m, summed over `dofs` in their order: the same bits whatever
/// the processor adds side by side.
template <typename Matrix>
Strips Product(const Eigen::Matrix<double, 3, Eigen::Dynamic>& by_q, const std::vector<int>& dofs,
               const Matrix& m, int column) {
  Strips::Strip x = Strips::Strip::Zero(), y = x, z = x;
  const Eigen::Index stride = m.outerStride();
  const double* const first = m.data() + column;
  const double* const weights = by_q.data();
  for (const int dof : dofs) {
    const Strips::Strip row = Eigen::Map<const Strips::Strip>(first + dof * stride);
    x += weights[3 * dof] * row;
    y += weights[3 * dof + 1] * row;
    z += weights[3 * dof + 2] * row;
  }
  return {x, y, z};
}

}  // namespace

GaussNewton::GaussNewton(const body::Body& body, const PoseBasis& basis,
                         const GaussNewtonOptions& options)
    : body_(&body),
      basis_(&basis),
      options_(options),
      covariance_(Rows::Zero(basis.dof(), WholeStrips(basis.dof()))),
      whitening_(basis.sd.cwiseInverse().asDiagonal() * basis.inverse),
      moved_by_(MovedBy(body.skeleton)),
      all_(static_cast<std::size_t>(basis.dof())),
      q_(basis.mean),
      q_before_(basis.mean),
      q_best_(basis.mean),
      step_q_(basis.mean),
      mean_(basis.mean),
      mean_before_(basis.mean),
      centre_(basis.mean),
      whitened_(basis.sd),
      blocks_(kMaxRows / 3),
      reach_(Rows::Zero(basis.dof(), WholeStrips(kMaxRows))),
      gram_(Rows::Zero(kMaxRows, WholeStrips(kMaxRows))),
      square_(kMaxRows, kMaxRows),
      open_reach_(3, WholeStrips(basis.dof())),
      open_across_(3, WholeStrips(kMaxRows)),
      residuals_(kMaxRows),
      pull_(kMaxRows),
      com_W_m_(Eigen::Vector3d::Zero()),
      at_(body.skeleton),
      room_(body.skeleton),
      centroidal_(6, basis.dof()) {
  FOOTING_CHECK(body.skeleton.dof == basis.dof());
  FOOTING_CHECK(options.prior_weight > 0 || options.smooth_weight > 0);
  covariance_.leftCols(basis.dof()).noalias() =
      basis.modes * basis.sd.cwiseAbs2().asDiagonal() * basis.modes.transpose();
  std::iota(all_.begin(), all_.end(), 0);
  for (Block& block : blocks_) block.by_q.setZero(3, basis.dof());
  open_.by_q.setZero(3, basis.dof());
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

/// By the degrees of freedom that move the joint alone.
void GaussNewton::PointBlock(const PointTarget& point, Block& out) {
  const auto joint = static_cast<std::size_t>(point.joint);
  const Eigen::Vector3d p_W_m = at_.p_WJ[joint] + at_.R_WJ[joint] * point.p_J_m;
  body::PointJacobian(body_->skeleton, at_, point.joint, p_W_m, out.by_q);
  out.dofs = &moved_by_[joint];
  if (point.from_joint >= 0) {
    const auto from = static_cast<std::size_t>(point.from_joint);
    Eigen::Matrix<double, 3, Eigen::Dynamic>& other = open_.by_q;
    body::PointJacobian(body_->skeleton, at_, point.from_joint, at_.p_WJ[from], other);
    out.by_q -= other;
    out.dofs = &all_;
  }
  const Eigen::Vector3d weight = point.sd_m.cwiseInverse();
  for (const int dof : *out.dofs) out.by_q.col(dof).array() *= weight.array();
}

void GaussNewton::Differentiate(const PoseTargets& targets) {
  int row = 0;
  for (int i = 0; i < targets.count; ++i, row += 3) {
    PointBlock(targets.points[static_cast<std::size_t>(i)], block(row));
  }
  if (targets.has_com) {
    block(row).dofs = &all_;
    body::ComJacobian(*body_, at_, room_, block(row).by_q);
    block(row).by_q.array().colwise() /= targets.com_sd_m.array();
    row += 3;
  }
  if (Angular(targets)) {
    block(row).dofs = &all_;
    block(row).by_q = (targets.angular_sd * options_.frame_s).cwiseInverse().asDiagonal() *
                      centroidal_.bottomRows<3>();
  }
  for (row = 0; row < row_count_; row += 3) {
    for (int dof = 0; dof < basis_->dof(); dof += kStrip) {
      const Strips part = Product(block(row).by_q, *block(row).dofs, covariance_, dof);
      for (int i = 0; i < std::min(kStrip, basis_->dof() - dof); ++i) {
        reach_.row(dof + i).segment<3>(row) << part.x(i), part.y(i), part.z(i);
      }
    }
  }
  for (row = 0; row < row_count_; row += 3) {
    for (int column = 0; column < row + 3; column += kStrip) {
      const Strips part = Product(block(row).by_q, *block(row).dofs, reach_, column);
      gram_.row(row).segment<kStrip>(column) = part.x.transpose();
      gram_.row(row + 1).segment<kStrip>(column) = part.y.transpose();
      gram_.row(row + 2).segment<kStrip>(column) = part.z.transpose();
    }
  }
}

/// The terms of the coefficients about `mean` and `start` are one about `centre_` and a constant.
double GaussNewton::Cost() {
  step_q_ = q_ - centre_;
  whitened_.noalias() = whitening_ * step_q_;
  return residuals_.head(row_count_).squaredNorm() + (prior_ + smooth_) * whitened_.squaredNorm();
}

/// With P the covariance that prior and smoothness alone would leave about their centre, H the
/// blocks and r the residuals, the pose is centre + P H' (1 + H P H')^-1 (r + H (q - centre)).
/// Damping holds to q itself, so it makes P smaller and draws the centre there.
void GaussNewton::TakeStep(double damping) {
  Factorise(damping);
  step_q_ = (q_ - centre_) * ((held_ - damping) / held_);
  auto pull = pull_.head(row_count_);
  for (int row = 0; row < row_count_; row += 3) {
    Eigen::Vector3d sum = residuals_.segment<3>(row);
    for (const int dof : *block(row).dofs) sum += step_q_(dof) * block(row).by_q.col(dof);
    pull.segment<3>(row) = sum;
  }
  const auto factor = square_.topLeftCorner(row_count_, row_count_);
  factor.triangularView<Eigen::Lower>().solveInPlace(pull);
  factor.transpose().triangularView<Eigen::Upper>().solveInPlace(pull);
  pull /= held_;
  q_ -= step_q_;
  q_.noalias() += reach_.leftCols(row_count_) * pull;
}

/// The Cholesky factor of 1 + H P H'.
void GaussNewton::Factorise(double damping) {
  held_ = prior_ + smooth_ + damping;
  Eigen::Ref<Rows> square = square_.topLeftCorner(row_count_, row_count_);
  square = gram_.topLeftCorner(row_count_, row_count_) / held_;
  square.diagonal().array() += 1;
  const Eigen::LLT<Eigen::Ref<Rows>> in_place(square);
}

double GaussNewton::JointSd(int joint) {
  const auto index = static_cast<std::size_t>(joint);
  body::PointJacobian(body_->skeleton, at_, joint, at_.p_WJ[index], open_.by_q);
  open_.dofs = &moved_by_[index];
  return std::sqrt(OpenVariances(open_).sum() / 3);
}

Eigen::Vector3d GaussNewton::ComSd() {
  body::ComJacobian(*body_, at_, room_, open_.by_q);
  open_.dofs = &all_;
  return OpenVariances(open_).cwiseSqrt();
}

Eigen::Vector3d GaussNewton::OpenVariances(const Block& block) {
  const auto into = [&](const Rows& m, int size, Rows& out) {
    for (int column = 0; column < size; column += kStrip) {
      const Strips part = Product(block.by_q, *block.dofs, m, column);
      out.row(0).segment<kStrip>(column) = part.x.transpose();
      out.row(1).segment<kStrip>(column) = part.y.transpose();
      out.row(2).segment<kStrip>(column) = part.z.transpose();
    }
  };
  into(covariance_, basis_->dof(), open_reach_);
  into(reach_, row_count_, open_across_);
  Eigen::Vector3d open = Eigen::Vector3d::Zero();
  for (const int dof : *block.dofs) {
    open += block.by_q.col(dof).cwiseProduct(open_reach_.col(dof)) / held_;
  }
  const auto factor = square_.topLeftCorner(row_count_, row_count_);
  for (int axis = 0; axis < 3; ++axis) {
    auto across = pull_.head(row_count_);
    across = open_across_.row(axis).head(row_count_).transpose() / held_;
    factor.triangularView<Eigen::Lower>().solveInPlace(across);
    open(axis) -= across.squaredNorm();
  }
  return open.cwiseMax(0);
}

void GaussNewton::ContinueFrom(const Eigen::VectorXd& q) {
  step_q_ = q - basis_->mean;
  whitened_.noalias() = basis_->inverse * step_q_;
  q_ = basis_->mean;
  q_.noalias() += basis_->modes * whitened_;
  mean_known_ = false;
  started_ = true;
}

void GaussNewton::Begin(const Eigen::VectorXd& likely_q) {
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

void GaussNewton::Solve(const PoseTargets& targets, const Eigen::VectorXd& likely_q) {
  FOOTING_CHECK(likely_q.size() == basis_->dof());
  Begin(likely_q);
  q_best_ = q_;
  const int iterations = started_ ? options_.iterations : options_.first_iterations;
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
  if (last_damping > 0) {  // What is told of the spread knows of no damping.
    Differentiate(targets);
    Factorise(0);
  }
  started_ = true;
}

}  // namespace footing::pose
