#include "common/virtual/devices/derivative.h"

#include <algorithm>

namespace footing::virtual_sensors {

Eigen::MatrixXd Derivative(const Eigen::MatrixXd& values, double rate_hz) {
  const Eigen::Index n = values.cols();
  Eigen::MatrixXd out(values.rows(), n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Eigen::Index low = std::max<Eigen::Index>(i - 1, 0), high = std::min(i + 1, n - 1);
    out.col(i) = (values.col(high) - values.col(low)) * (rate_hz / static_cast<double>(high - low));
  }
  return out;
}

}  // namespace footing::virtual_sensors
