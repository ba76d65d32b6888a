#include "common/virtual_sensors/low_pass.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace footing::virtual_sensors {
namespace {

struct Coefficients {
  double b0, b1, b2, a1, a2;
};

Coefficients Butterworth(double cutoff_hz, double rate_hz) {
  const double k = std::tan(std::numbers::pi * cutoff_hz / rate_hz);
  const double d = 1 + std::numbers::sqrt2 * k + k * k;
  return {k * k / d, 2 * k * k / d, k * k / d, 2 * (k * k - 1) / d,
          (1 - std::numbers::sqrt2 * k + k * k) / d};
}

// One pass over the columns, from rest at the first one.
void Pass(const Coefficients& c, Eigen::MatrixXd& x) {
  const Eigen::VectorXd start = x.col(0);
  Eigen::VectorXd x1 = Eigen::VectorXd::Zero(x.rows()), x2 = x1, y1 = x1, y2 = x1;
  for (Eigen::Index i = 0; i < x.cols(); ++i) {
    const Eigen::VectorXd x0 = x.col(i) - start;
    const Eigen::VectorXd y0 = c.b0 * x0 + c.b1 * x1 + c.b2 * x2 - c.a1 * y1 - c.a2 * y2;
    x2 = x1;
    x1 = x0;
    y2 = y1;
    y1 = y0;
    x.col(i) = y0 + start;
  }
}

}  // namespace

Eigen::MatrixXd LowPass(const Eigen::MatrixXd& values, double cutoff_hz, double rate_hz) {
  const Eigen::Index n = values.cols();
  if (n < 3 || cutoff_hz >= 0.5 * rate_hz) return values;
  const Eigen::Index pad =
      std::min<Eigen::Index>(n - 1, static_cast<Eigen::Index>(std::ceil(2 * rate_hz / cutoff_hz)));
  Eigen::MatrixXd x(values.rows(), n + 2 * pad);
  x.middleCols(pad, n) = values;
  for (Eigen::Index i = 1; i <= pad; ++i) {
    x.col(pad - i) = 2 * values.col(0) - values.col(i);
    x.col(pad + n - 1 + i) = 2 * values.col(n - 1) - values.col(n - 1 - i);
  }
  const Coefficients c = Butterworth(cutoff_hz, rate_hz);
  for (int pass = 0; pass < 2; ++pass) {
    Pass(c, x);
    x = x.rowwise().reverse().eval();
  }
  return x.middleCols(pad, n);
}

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
