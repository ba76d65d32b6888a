#include "daemon/offline/learning/mlp.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "common/base/result.h"
#include "common/base/units.h"
#include "common/virtual/devices/noise.h"
#include "daemon/offline/learning/candidates.h"

namespace footing::learning {

Split SplitInTime(const Examples& all, double fraction) {
  const auto last =
      static_cast<Eigen::Index>(std::floor(fraction * static_cast<double>(all.rows())));
  const Eigen::Index first = all.rows() - last;
  return {.train = {all.inputs.topRows(first), all.targets.topRows(first)},
          .validation = {all.inputs.bottomRows(last), all.targets.bottomRows(last)}};
}

Examples Joined(const std::vector<const Examples*>& parts) {
  FOOTING_CHECK(!parts.empty());
  Eigen::Index rows = 0;
  for (const Examples* part : parts) rows += part->rows();
  Examples all{.inputs = Eigen::MatrixXd(rows, parts.front()->inputs.cols()),
               .targets = Eigen::MatrixXd(rows, parts.front()->targets.cols())};
  Eigen::Index row = 0;
  for (const Examples* part : parts) {
    all.inputs.middleRows(row, part->rows()) = part->inputs;
    all.targets.middleRows(row, part->rows()) = part->targets;
    row += part->rows();
  }
  return all;
}

Examples WithFeedbackNoise(const Examples& examples, const FeedbackNoise& noise,
                           std::uint64_t seed) {
  if (noise.groups.empty()) return examples;
  Examples noisy{.inputs = examples.inputs.replicate(noise.copies, 1),
                 .targets = examples.targets.replicate(noise.copies, 1)};
  noise::Random random(seed);
  for (Eigen::Index row = 0; row < noisy.rows(); ++row) {
    for (const std::vector<Eigen::Index>& group : noise.groups) {
      const double common = noise.common_sd * random.Normal();
      for (const Eigen::Index column : group) {
        noisy.inputs(row, column) += common + noise.own_sd * random.Normal();
      }
    }
  }
  return noisy;
}

namespace {

Eigen::MatrixXd WithBias(const Eigen::MatrixXd& values) {
  Eigen::MatrixXd with(values.rows(), 1 + values.cols());
  with << Eigen::VectorXd::Ones(values.rows()), values;
  return with;
}

/// Uniform within +-1 / sqrt(weights of a unit).
Eigen::MatrixXd Drawn(Eigen::Index rows, Eigen::Index columns, noise::Random& random) {
  Eigen::MatrixXd weights(rows, columns);
  const double range = 1 / std::sqrt(static_cast<double>(columns));
  for (double& weight : weights.reshaped()) weight = random.Uniform(-range, range);
  return weights;
}

/// Fisher-Yates: std::shuffle's draws are not fixed by the standard.
void Shuffle(std::vector<Eigen::Index>& order, noise::Random& random) {
  for (std::size_t i = order.size(); i > 1; --i) {
    std::swap(order[i - 1],
              order[static_cast<std::size_t>(random.Uniform() * static_cast<double>(i))]);
  }
}

model::Tensor ToTensor(const char* name, const Eigen::MatrixXd& values) {
  return {.name = name,
          .shape = {static_cast<std::uint32_t>(values.rows()),
                    static_cast<std::uint32_t>(values.cols())},
          .values = ToFloats(values.transpose())};
}

}  // namespace

Eigen::MatrixXd Mlp::Evaluate(const Eigen::MatrixXd& inputs) const {
  const Eigen::MatrixXd units = WithBias(input_scaling.Apply(inputs));
  const Eigen::MatrixXd hidden = Sigmoid((units * hidden_weights.transpose()).array()).matrix();
  Eigen::MatrixXd outputs = WithBias(hidden) * output_weights.transpose();
  outputs.array().rowwise() /= output_scaling.scale.array();
  outputs.rowwise() += output_scaling.mean;
  return outputs;
}

double MeanSquaredError(const Mlp& network, const Examples& examples) {
  if (examples.targets.size() == 0) return 0;
  return (network.Evaluate(examples.inputs) - examples.targets).squaredNorm() /
         static_cast<double>(examples.targets.size());
}

void AppendTensors(const Mlp& network, model::Model& model) {
  model.tensors.push_back(ToTensor("input_mean", network.input_scaling.mean));
  model.tensors.push_back(ToTensor("input_scale", network.input_scaling.scale));
  model.tensors.push_back(ToTensor("hidden_weights", network.hidden_weights));
  model.tensors.push_back(ToTensor("output_weights", network.output_weights));
  model.tensors.push_back(ToTensor("output_mean", network.output_scaling.mean));
  model.tensors.push_back(ToTensor("output_scale", network.output_scaling.scale.cwiseInverse()));
}

MlpGradient Gradient(const Mlp& network, const Eigen::MatrixXd& scaled_inputs,
                     const Eigen::MatrixXd& scaled_targets) {
  const Eigen::MatrixXd units = WithBias(scaled_inputs);
  const Eigen::MatrixXd values =
      Sigmoid((units * network.hidden_weights.transpose()).array()).matrix();
  const Eigen::MatrixXd hidden = WithBias(values);
  const auto count = static_cast<double>(scaled_targets.size());
  const Eigen::MatrixXd errors =
      (hidden * network.output_weights.transpose() - scaled_targets) / count;
  const Eigen::MatrixXd back = (errors * network.output_weights.rightCols(values.cols())).array() *
                               (0.25 - values.array().square());
  return {.error = 0.5 * errors.squaredNorm() * count,
          .hidden_weights = back.transpose() * units,
          .output_weights = errors.transpose() * hidden};
}

MlpResult TrainMlp(const Examples& train, const Examples& validation, const MlpOptions& options,
                   std::uint64_t seed) {
  FOOTING_CHECK(train.rows() > 0 && options.batch > 0 && options.hidden > 0);
  noise::Random random(seed);
  Mlp network{.input_scaling = Scaling::Of(train.inputs),
              .output_scaling = Scaling::Of(train.targets),
              .hidden_weights = Drawn(options.hidden, 1 + train.inputs.cols(), random),
              .output_weights = Drawn(train.targets.cols(), 1 + options.hidden, random)};
  auto& scale = network.output_scaling.scale;
  scale = (scale.array() > 0).select(scale, 1);
  const Eigen::MatrixXd inputs = network.input_scaling.Apply(train.inputs);
  const Eigen::MatrixXd targets = network.output_scaling.Apply(train.targets);
  const Examples& judged_on = validation.rows() > 0 ? validation : train;

  std::vector<Eigen::Index> order(static_cast<std::size_t>(train.rows()));
  std::iota(order.begin(), order.end(), 0);
  Eigen::MatrixXd hidden_step =
      Eigen::MatrixXd::Zero(network.hidden_weights.rows(), network.hidden_weights.cols());
  Eigen::MatrixXd output_step =
      Eigen::MatrixXd::Zero(network.output_weights.rows(), network.output_weights.cols());
  MlpResult result{.network = network};
  double best_mse = std::numeric_limits<double>::infinity();
  for (int last_better = 0; result.epochs < options.epochs_max && !result.goal_reached &&
                            result.epochs - last_better < options.patience;) {
    Shuffle(order, random);
    for (std::size_t first = 0; first < order.size();
         first += static_cast<std::size_t>(options.batch)) {
      const std::size_t end =
          std::min(order.size(), first + static_cast<std::size_t>(options.batch));
      const std::vector<Eigen::Index> rows(order.begin() + static_cast<std::ptrdiff_t>(first),
                                           order.begin() + static_cast<std::ptrdiff_t>(end));
      const MlpGradient gradient =
          Gradient(network, inputs(rows, Eigen::all), targets(rows, Eigen::all));
      hidden_step = options.momentum * hidden_step - options.rate * gradient.hidden_weights;
      output_step = options.momentum * output_step - options.rate * gradient.output_weights;
      network.hidden_weights += hidden_step;
      network.output_weights += output_step;
    }
    ++result.epochs;
    const double mse = MeanSquaredError(network, judged_on);
    if (mse < best_mse) {
      best_mse = mse;
      last_better = result.epochs;
      result.network = network;
    }
    result.goal_reached = mse <= options.mse_goal;
  }
  result.train_mse = MeanSquaredError(result.network, train);
  result.validation_mse = MeanSquaredError(result.network, validation);
  return result;
}

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
