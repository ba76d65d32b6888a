#include "daemon/simulation/pose/basis.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

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

PoseBasis Unconnected(const PoseBasis& basis) {
  PoseBasis single;
  single.mean = basis.mean;
  single.modes = Eigen::MatrixXd::Identity(basis.dof(), basis.dof());
  single.inverse = single.modes;
  single.sd = (basis.modes * basis.sd.asDiagonal()).rowwise().norm().cwiseMax(1e-4);
  return single;
}

}  // namespace footing::pose
