#include "daemon/simulation/pose/pose_update.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <vector>

namespace footing::pose {
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

}  // namespace footing::pose
