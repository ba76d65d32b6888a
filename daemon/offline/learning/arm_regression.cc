#include "daemon/offline/learning/arm_regression.h"

#include <utility>

#include "common/base/result.h"
#include "daemon/offline/learning/ridge.h"
#include "daemon/offline/learning/scaling.h"

namespace footing::learning {

FittedArm FitArm(const ArmExamples& examples) {
  FOOTING_CHECK(!examples.features.empty() && examples.fold_count >= 2 &&
                examples.features.size() == examples.directions.size());
  const auto count = static_cast<Eigen::Index>(examples.features.size());
  Eigen::MatrixXd x(arms::ArmFeatures::kCount, count), y(arms::kDirections, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    x.col(i) = examples.features[static_cast<std::size_t>(i)];
    y.col(i) = examples.directions[static_cast<std::size_t>(i)];
  }
  RidgeFit fit = FitRidge(std::move(x), std::move(y), examples.folds, examples.fold_count,
                          Eigen::VectorXd::Ones(arms::kDirections));
  FittedArm fitted;
  fitted.ridge = fit.ridge;
  fitted.error = fit.error;
  fitted.spread = fit.spread;
  fitted.model = {fit.mean, fit.scale, std::move(fit.weights), fit.offset,
                  fit.errors * fit.errors.transpose() / static_cast<double>(count)};
  return fitted;
}

void AppendTensors(const arms::ArmModel& fitted, model::Model& model) {
  const auto add = [&model](const char* name, const Eigen::MatrixXd& rows) {
    std::vector<std::uint32_t> shape{static_cast<std::uint32_t>(rows.rows())};
    if (rows.cols() > 1) shape.push_back(static_cast<std::uint32_t>(rows.cols()));
    model.tensors.push_back({.name = name, .shape = shape, .values = ToFloats(rows.transpose())});
  };
  add("feature_mean", fitted.mean);
  add("feature_scale", fitted.scale);
  add("regression_weights", fitted.weights);
  add("regression_offset", fitted.offset);
  add("error_covariance", fitted.covariance);
}

}  // namespace footing::learning
