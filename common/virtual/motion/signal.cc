#include "common/virtual/motion/signal.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/base/result.h"
#include "common/base/units.h"

namespace footing::motion {
namespace {

constexpr double kHighestCutoffOfRate = 0.45;

struct Biquad {
  double b0, b1, b2, a1, a2;
};

/// Bilinear transform of 1 / (s^2 + sqrt(2) s + 1), warped to the cutoff.
Biquad Butterworth(double cutoff_of_rate) {
  const double w = std::tan(kPi * cutoff_of_rate);
  const double scale = 1 / (1 + std::sqrt(2.0) * w + w * w);
  return {w * w * scale, 2 * w * w * scale, w * w * scale, 2 * (w * w - 1) * scale,
          (1 - std::sqrt(2.0) * w + w * w) * scale};
}

/// Runs the filter along the columns in place, as if the first column had stood there for ever.
void Run(const Biquad& f, Eigen::MatrixXd& signal) {
  Eigen::VectorXd in1 = signal.col(0), in2 = in1, out1 = in1, out2 = in1;
  for (Eigen::Index i = 0; i < signal.cols(); ++i) {
    const Eigen::VectorXd in = signal.col(i);
    const Eigen::VectorXd out = f.b0 * in + f.b1 * in1 + f.b2 * in2 - f.a1 * out1 - f.a2 * out2;
    in2 = std::exchange(in1, in);
    out2 = std::exchange(out1, out);
    signal.col(i) = out;
  }
}

}  // namespace

Eigen::MatrixXd LowPass(const Eigen::MatrixXd& signal, double rate_hz, double cutoff_hz) {
  FOOTING_CHECK(rate_hz > 0 && cutoff_hz > 0);
  const Eigen::Index frames = signal.cols();
  // (sqrt(2) - 1)^(1/4): two passes of a second-order filter.
  const double single_of_rate = cutoff_hz / rate_hz / std::pow(std::sqrt(2.0) - 1, 0.25);
  if (frames < 3 || single_of_rate >= kHighestCutoffOfRate) return signal;
  // Long enough for the filter to settle: it forgets within one period of its cutoff.
  const Eigen::Index pad =
      std::min(frames - 1, static_cast<Eigen::Index>(std::ceil(1 / single_of_rate)) + 3);
  Eigen::MatrixXd wide(signal.rows(), frames + 2 * pad);
  for (Eigen::Index i = 0; i < pad; ++i) {
    wide.col(pad - 1 - i) = 2 * signal.col(0) - signal.col(i + 1);
    wide.col(pad + frames + i) = 2 * signal.col(frames - 1) - signal.col(frames - 2 - i);
  }
  wide.middleCols(pad, frames) = signal;
  const Biquad filter = Butterworth(single_of_rate);
  Run(filter, wide);
  wide = wide.rowwise().reverse().eval();
  Run(filter, wide);
  return wide.rowwise().reverse().middleCols(pad, frames);
}

Spline::Spline(Eigen::MatrixXd samples, double rate_hz)
    : samples_(std::move(samples)), rate_hz_(rate_hz) {
  FOOTING_CHECK(samples_.cols() > 0 && rate_hz > 0);
  const Eigen::Index n = samples_.cols();
  curvatures_.setZero(samples_.rows(), n);
  if (n < 3) return;
  // c[i-1] + 4 c[i] + c[i+1] = 6 (x[i-1] - 2 x[i] + x[i+1]) / h^2, c = 0 at both ends.
  Eigen::VectorXd upper(n);
  upper(0) = 0;
  for (Eigen::Index i = 1; i + 1 < n; ++i) {
    const double pivot = 1 / (4 - upper(i - 1));
    upper(i) = pivot;
    curvatures_.col(i) =
        pivot *
        (6 * rate_hz * rate_hz * (samples_.col(i - 1) - 2 * samples_.col(i) + samples_.col(i + 1)) -
         curvatures_.col(i - 1));
  }
  for (Eigen::Index i = n - 3; i >= 1; --i) {
    curvatures_.col(i) -= upper(i) * curvatures_.col(i + 1);
  }
}

Spline::Place Spline::At(double t_s) const {
  const double last = static_cast<double>(samples_.cols() - 1);
  const double at = std::clamp(t_s * rate_hz_, 0.0, last);
  const auto before = std::clamp<Eigen::Index>(static_cast<Eigen::Index>(at), 0,
                                               std::max<Eigen::Index>(samples_.cols() - 2, 0));
  return {before, at - static_cast<double>(before)};
}

Eigen::VectorXd Spline::Value(double t_s) const {
  if (samples_.cols() == 1) return samples_.col(0);
  const auto [i, b] = At(t_s);
  const double a = 1 - b, h2 = 1 / (6 * rate_hz_ * rate_hz_);
  return a * samples_.col(i) + b * samples_.col(i + 1) +
         h2 * ((a * a * a - a) * curvatures_.col(i) + (b * b * b - b) * curvatures_.col(i + 1));
}

Eigen::VectorXd Spline::FirstDerivative(double t_s) const {
  if (samples_.cols() == 1) return Eigen::VectorXd::Zero(samples_.rows());
  const auto [i, b] = At(t_s);
  const double a = 1 - b, h = 1 / (6 * rate_hz_);
  return rate_hz_ * (samples_.col(i + 1) - samples_.col(i)) +
         h * ((1 - 3 * a * a) * curvatures_.col(i) + (3 * b * b - 1) * curvatures_.col(i + 1));
}

Eigen::VectorXd Spline::SecondDerivative(double t_s) const {
  if (samples_.cols() == 1) return Eigen::VectorXd::Zero(samples_.rows());
  const auto [i, b] = At(t_s);
  return (1 - b) * curvatures_.col(i) + b * curvatures_.col(i + 1);
}

}  // namespace footing::motion
