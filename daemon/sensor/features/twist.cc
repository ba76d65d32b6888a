#include "daemon/sensor/features/twist.h"

#include <Eigen/Eigenvalues>
#include <cmath>

#include "daemon/sensor/features/cycle.h"

namespace footing::features {
namespace {

template <typename Rows>
Eigen::Matrix3d Covariance(const Rows& rows) {
  const Eigen::Matrix<double, Eigen::Dynamic, 3> centred = rows.rowwise() - rows.colwise().mean();
  return centred.transpose() * centred / static_cast<double>(rows.rows());
}

}  // namespace

Eigen::Vector3d FindTwist(const SampleGrid& grid, int points, double steps,
                          const CadenceConfig& config) {
  const int count = static_cast<int>(std::floor(steps)) + 2;
  Eigen::Matrix<double, kGridLength, 3> means;
  int cycles = 0;
  for (int late = 0; late + count <= points; late = static_cast<int>(cycles * steps)) {
    means.row(cycles++) = CycleMean(grid, late, steps);
  }
  if (cycles < 2) return Eigen::Vector3d::Zero();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> spread(Covariance(means.topRows(cycles)));
  const Eigen::Matrix3d swing = Covariance(grid.Filtered(count));
  if (spread.eigenvalues()(2) < config.twist_share * config.twist_share * swing.trace()) {
    return Eigen::Vector3d::Zero();
  }
  const Eigen::Vector3d twist = spread.eigenvectors().col(2);
  const double across = swing.trace() - twist.dot(swing * twist);
  if (across < config.least_across_share * swing.trace()) return Eigen::Vector3d::Zero();
  return twist;
}

}  // namespace footing::features
