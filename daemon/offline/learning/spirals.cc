#include "daemon/offline/learning/spirals.h"

#include <cmath>

#include "common/base/units.h"

namespace footing::learning {

Examples TwoSpirals(int denser) {
  const int points = 96 * denser + 1;
  Examples examples{.inputs = Eigen::MatrixXd(2 * points, 2),
                    .targets = Eigen::MatrixXd(2 * points, 1)};
  for (int i = 0; i < points; ++i) {
    const double along = static_cast<double>(i) / denser;
    const double radius = 6.5 * (104 - along) / 104;
    const double angle = along * kPi / 16;
    const Eigen::RowVector2d point(radius * std::sin(angle), radius * std::cos(angle));
    examples.inputs.row(2 * i) = point;
    examples.inputs.row(2 * i + 1) = -point;
    examples.targets(2 * i, 0) = 0.5;
    examples.targets(2 * i + 1, 0) = -0.5;
  }
  return examples;
}

}  // namespace footing::learning
