#include "daemon/offline/learning/scaling.h"

namespace footing::learning {

Scaling Scaling::Of(const Eigen::MatrixXd& values) {
  const auto rows = static_cast<double>(values.rows());
  Scaling scaling{.mean = values.colwise().mean(), .scale = {}};
  const Eigen::RowVectorXd sd =
      ((values.rowwise() - scaling.mean).colwise().squaredNorm() / rows).cwiseSqrt();
  // Below this a column varies by rounding alone.
  const Eigen::RowVectorXd least = 1e-12 * (1 + scaling.mean.array().abs());
  scaling.scale = (sd.array() > least.array()).select(sd.cwiseInverse(), 0);
  return scaling;
}

Scaling Scaling::None(Eigen::Index columns) {
  return {.mean = Eigen::RowVectorXd::Zero(columns), .scale = Eigen::RowVectorXd::Ones(columns)};
}

Eigen::MatrixXd Scaling::Apply(const Eigen::MatrixXd& values) const {
  return ((values.rowwise() - mean).array().rowwise() * scale.array()).matrix();
}

std::vector<float> ToFloats(const Eigen::MatrixXd& values) {
  const Eigen::MatrixXf floats = values.cast<float>();
  return {floats.data(), floats.data() + floats.size()};
}

}  // namespace footing::learning
