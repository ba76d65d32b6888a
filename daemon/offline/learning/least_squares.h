#pragma once

#include <Eigen/Core>

namespace footing::learning {

/// Linear outputs of least squared error over columns that come one at a time: modified
/// Gram-Schmidt, orthogonalised twice. What Quickprop on linear outputs goes towards, at once.
class LeastSquares {
 public:
  /// `targets`: rows x outputs. At most `columns_max` columns will come.
  LeastSquares(const Eigen::MatrixXd& targets, Eigen::Index columns_max);

  /// A column that the ones before it explain gets weight 0.
  void Add(const Eigen::VectorXd& column);

  /// Prediction less target: at right angles to every column so far.
  const Eigen::MatrixXd& errors() const { return errors_; }

  /// Orthonormal, as many columns as were added; a column that was left out is 0 here.
  auto basis() const { return basis_.leftCols(columns_); }

  /// Columns so far x outputs.
  Eigen::MatrixXd Weights() const;

 private:
  Eigen::MatrixXd basis_;     ///< Orthonormal, Q.
  Eigen::MatrixXd triangle_;  ///< R: columns = Q R; a 0 on the diagonal marks a column left out.
  Eigen::MatrixXd along_;     ///< Q' targets.
  Eigen::MatrixXd errors_;
  Eigen::Index columns_ = 0;
};

}  // namespace footing::learning
