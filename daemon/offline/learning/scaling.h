#pragma once

#include <Eigen/Core>
#include <vector>

namespace footing::learning {

/// Columns to mean 0 and standard deviation 1. A constant column becomes 0.
struct Scaling {
  Eigen::RowVectorXd mean, scale;  ///< scaled = (value - mean) scale

  static Scaling Of(const Eigen::MatrixXd& values);
  /// Leaves every value as it is.
  static Scaling None(Eigen::Index columns);

  Eigen::MatrixXd Apply(const Eigen::MatrixXd& values) const;
};

std::vector<float> ToFloats(const Eigen::MatrixXd& values);  ///< Column by column.

}  // namespace footing::learning
