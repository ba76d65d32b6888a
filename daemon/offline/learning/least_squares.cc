#include "daemon/offline/learning/least_squares.h"

#include "common/base/result.h"

namespace footing::learning {
namespace {

/// A column's part that is new, over the whole: below it there is nothing but rounding.
constexpr double kLeastNewPart = 1e-10;

}  // namespace

LeastSquares::LeastSquares(const Eigen::MatrixXd& targets, Eigen::Index columns_max)
    : basis_(Eigen::MatrixXd::Zero(targets.rows(), columns_max)),
      triangle_(Eigen::MatrixXd::Zero(columns_max, columns_max)),
      along_(Eigen::MatrixXd::Zero(columns_max, targets.cols())),
      errors_(-targets) {}

void LeastSquares::Add(const Eigen::VectorXd& column) {
  FOOTING_CHECK(columns_ < basis_.cols());
  Eigen::VectorXd rest = column;
  const auto before = basis_.leftCols(columns_);
  for (int time = 0; time < 2; ++time) {
    const Eigen::VectorXd parts = before.transpose() * rest;
    rest.noalias() -= before * parts;
    triangle_.col(columns_).head(columns_) += parts;
  }
  const double size = rest.norm();
  if (size > kLeastNewPart * column.norm()) {
    triangle_(columns_, columns_) = size;
    basis_.col(columns_) = rest / size;
    const Eigen::RowVectorXd along = -basis_.col(columns_).transpose() * errors_;
    along_.row(columns_) = along;
    errors_.noalias() += basis_.col(columns_) * along;
  }
  ++columns_;
}

Eigen::MatrixXd LeastSquares::Weights() const {
  Eigen::MatrixXd weights = Eigen::MatrixXd::Zero(columns_, along_.cols());
  for (Eigen::Index row = columns_ - 1; row >= 0; --row) {
    if (triangle_(row, row) == 0) continue;
    const Eigen::Index later = columns_ - 1 - row;
    weights.row(row) =
        (along_.row(row) - triangle_.row(row).segment(row + 1, later) * weights.bottomRows(later)) /
        triangle_(row, row);
  }
  return weights;
}

}  // namespace footing::learning
