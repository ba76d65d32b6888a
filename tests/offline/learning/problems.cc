#include "tests/offline/learning/problems.h"

#include <cmath>

#include "common/virtual/devices/noise.h"

namespace footing::learning {

Examples Parity(int bits) {
  const int rows = 1 << bits;
  Examples examples{.inputs = Eigen::MatrixXd(rows, bits), .targets = Eigen::MatrixXd(rows, 1)};
  for (int row = 0; row < rows; ++row) {
    bool odd = false;
    for (int bit = 0; bit < bits; ++bit) {
      const bool up = (row >> bit & 1) != 0;
      odd = odd != up;
      examples.inputs(row, bit) = up ? 0.5 : -0.5;
    }
    examples.targets(row, 0) = odd ? 0.5 : -0.5;
  }
  return examples;
}

Examples Curved(int rows, double noise_sd, std::uint64_t seed) {
  noise::Random random(seed);
  Examples examples{.inputs = Eigen::MatrixXd(rows, 3), .targets = Eigen::MatrixXd(rows, 1)};
  for (int row = 0; row < rows; ++row) {
    const double a = random.Uniform(-1, 1), b = random.Uniform(-1, 1), c = random.Uniform(-1, 1);
    examples.inputs.row(row) << a, b, c;
    examples.targets(row, 0) = std::sin(2 * a) + b * c + 0.3 * a * a + noise_sd * random.Normal();
  }
  return examples;
}

}  // namespace footing::learning
