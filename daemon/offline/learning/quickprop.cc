#include "daemon/offline/learning/quickprop.h"

#include <algorithm>
#include <cmath>

namespace footing::learning {
namespace {

/// The next step of one weight. Where the slope still points the way of the last step, the parabola
/// is followed only while it is steep enough; else the step grows by `growth`.
double NextStep(double slope, double last_slope, double last_step,
                const QuickpropOptions& options) {
  const double shrink = options.growth / (1 + options.growth);
  const bool downhill_still = slope * last_step < 0;
  double step = 0;
  if (last_step == 0 || downhill_still) step -= options.epsilon * slope;
  if (last_step == 0) return step;
  const bool beyond = last_step < 0 ? slope >= shrink * last_slope : slope <= shrink * last_slope;
  if (beyond) return step + options.growth * last_step;
  const double most = options.growth * std::abs(last_step);
  const double curvature = last_slope - slope;
  if (curvature == 0) return step + options.growth * last_step;
  return step + std::clamp(last_step * slope / curvature, -most, most);
}

}  // namespace

Quickprop::Quickprop(Eigen::Index rows, Eigen::Index columns, const QuickpropOptions& options)
    : options_(options),
      last_steps_(Eigen::MatrixXd::Zero(rows, columns)),
      last_slopes_(Eigen::MatrixXd::Zero(rows, columns)) {}

void Quickprop::Step(const Eigen::MatrixXd& slopes, Eigen::MatrixXd& weights) {
  for (Eigen::Index i = 0; i < weights.size(); ++i) {
    double& weight = weights.data()[i];
    const double slope = slopes.data()[i] + options_.decay * weight;
    const double step = NextStep(slope, last_slopes_.data()[i], last_steps_.data()[i], options_);
    weight += step;
    last_steps_.data()[i] = step;
    last_slopes_.data()[i] = slope;
  }
}

}  // namespace footing::learning
