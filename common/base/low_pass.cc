#include "common/base/low_pass.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/base/result.h"
#include "common/base/units.h"

namespace footing {
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

}  // namespace footing
