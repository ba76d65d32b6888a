#include "daemon/offline/learning/sigmoid_outputs.h"

#include <cmath>

#include "daemon/offline/learning/candidates.h"

namespace footing::learning {
namespace {

constexpr double kPrimeOffset = 0.1;

}  // namespace

void SigmoidOutputs::Evaluate(const Eigen::MatrixXd& units, const Eigen::MatrixXd& targets) {
  values = Sigmoid((units * weights).array()).matrix();
  errors = ((values - targets).array() * (0.25 - values.array().square() + kPrimeOffset)).matrix();
}

int SigmoidOutputs::Train(const Eigen::MatrixXd& units, const Eigen::MatrixXd& targets, double near,
                          const OutputOptions& options) {
  QuickpropOptions scaled = options.quickprop;
  scaled.epsilon /= static_cast<double>(units.rows());
  Quickprop quickprop(weights.rows(), weights.cols(), scaled);
  double last_error = 0;
  int quit = options.patience;
  for (int epoch = 0; epoch < options.epochs_max; ++epoch) {
    Evaluate(units, targets);
    if (Worst(targets) < near) return epoch;
    const double error = errors.squaredNorm();
    if (epoch == 0 || std::abs(error - last_error) > options.change * last_error) {
      last_error = error;
      quit = epoch + options.patience;
    } else if (epoch >= quit) {
      return epoch;
    }
    quickprop.Step(units.transpose() * errors, weights);
  }
  Evaluate(units, targets);
  return options.epochs_max;
}

double SigmoidOutputs::Worst(const Eigen::MatrixXd& targets) const {
  return (values - targets).cwiseAbs().maxCoeff();
}

}  // namespace footing::learning
