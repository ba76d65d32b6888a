#include "daemon/offline/learning/cascade.h"

#include <algorithm>
#include <limits>

#include "daemon/offline/learning/least_squares.h"
#include "daemon/offline/learning/scaling.h"

namespace footing::learning {
namespace {

using cascade::NetworkWeights;

/// The values of bias, inputs and hidden units over a set of rows; grows by a column.
struct Units {
  Units(const Eigen::MatrixXd& scaled_inputs, Eigen::Index columns_max)
      : values(scaled_inputs.rows(), columns_max), columns(1 + scaled_inputs.cols()) {
    values.col(0).setOnes();
    values.middleCols(1, scaled_inputs.cols()) = scaled_inputs;
  }

  void Add(const Eigen::VectorXd& weights) {
    const Eigen::VectorXd sums = values.leftCols(columns) * weights;
    values.col(columns) = Sigmoid(sums.array()).matrix();
    ++columns;
  }
  auto used() const { return values.leftCols(columns); }

  Eigen::MatrixXd values;
  Eigen::Index columns;
};

/// The output layer of either sort: weights, and the error that candidates follow.
class OutputLayer {
 public:
  OutputLayer(const Eigen::MatrixXd& targets, const Units& units, const CascadeOptions& options)
      : options_(options), targets_(targets), solver_(targets, units.values.cols()) {
    if (options.outputs == Outputs::kLinear) {
      for (Eigen::Index i = 0; i < units.columns; ++i) solver_.Add(units.values.col(i));
    }
  }

  /// First weights of sigmoid outputs.
  void Draw(Eigen::Index columns, noise::Random& random) {
    sigmoid_.weights.resize(columns, targets_.cols());
    const double range = options_.candidates.weight_range;
    for (double& weight : sigmoid_.weights.reshaped()) weight = random.Uniform(-range, range);
  }

  /// A sigmoid output starts with the weight that goes against the correlation.
  void Add(const NewUnit& unit) {
    if (options_.outputs == Outputs::kLinear) return solver_.Add(unit.values);
    sigmoid_.weights.conservativeResize(sigmoid_.weights.rows() + 1, Eigen::NoChange);
    sigmoid_.weights.bottomRows(1) = -unit.correlations.transpose();
  }

  /// Epochs used.
  int Train(const Units& units) {
    if (options_.outputs == Outputs::kLinear) return 1;
    return sigmoid_.Train(units.used(), targets_, options_.near, options_.output_training);
  }

  Eigen::MatrixXd Weights() const {
    return options_.outputs == Outputs::kLinear ? solver_.Weights() : sigmoid_.weights;
  }
  const Eigen::MatrixXd& errors() const {
    return options_.outputs == Outputs::kLinear ? solver_.errors() : sigmoid_.errors;
  }
  CandidateTask Task(const Units& units) const {
    if (options_.outputs == Outputs::kLinear && options_.objective == Objective::kErrorReduction) {
      return CandidateTask::ErrorReduction(units.used(), errors(), solver_.basis());
    }
    return CandidateTask::Covariance(units.used(), errors());
  }
  bool AllNear() const {
    return options_.outputs == Outputs::kSigmoid && sigmoid_.Worst(targets_) < options_.near;
  }

 private:
  CascadeOptions options_;
  Eigen::MatrixXd targets_;
  LeastSquares solver_;
  SigmoidOutputs sigmoid_;
};

/// In the targets' unit squared.
double Mse(const Units& units, const Eigen::MatrixXd& weights, const Scaling& scaling,
           const Eigen::MatrixXd& targets, Outputs outputs) {
  if (targets.size() == 0) return 0;
  Eigen::MatrixXd values = units.used() * weights;
  if (outputs == Outputs::kSigmoid) values = Sigmoid(values.array()).matrix();
  values.array().rowwise() /= scaling.scale.array();
  values.rowwise() += scaling.mean;
  return (values - targets).squaredNorm() / static_cast<double>(targets.size());
}

}  // namespace

double MeanSquaredError(const cascade::CascadeNetwork& network, const Examples& examples) {
  if (examples.targets.size() == 0) return 0;
  std::vector<float> inputs(static_cast<std::size_t>(examples.inputs.cols()));
  std::vector<float> outputs(static_cast<std::size_t>(examples.targets.cols()));
  double sum = 0;
  for (Eigen::Index row = 0; row < examples.rows(); ++row) {
    Eigen::RowVectorXf::Map(inputs.data(), examples.inputs.cols()) =
        examples.inputs.row(row).cast<float>();
    network.Evaluate(inputs, outputs);
    sum += (Eigen::RowVectorXf::Map(outputs.data(), examples.targets.cols()).cast<double>() -
            examples.targets.row(row))
               .squaredNorm();
  }
  return sum / static_cast<double>(examples.targets.size());
}

CascadeResult TrainCascade(const Examples& train, const Examples& validation,
                           const CascadeOptions& options, std::uint64_t seed) {
  FOOTING_CHECK(train.rows() > 0 && train.targets.rows() == train.rows());
  noise::Random random(seed);
  const Eigen::Index outputs = train.targets.cols();
  const Scaling in = Scaling::Of(train.inputs);
  Scaling out = Scaling::None(outputs);
  if (options.outputs == Outputs::kLinear) {
    out = Scaling::Of(train.targets);
    out.scale = (out.scale.array() > 0).select(out.scale, 1);
  }
  const Eigen::Index columns_max = 1 + train.inputs.cols() + options.hidden_max;
  Units units(in.Apply(train.inputs), columns_max);
  Units held_out(
      validation.rows() > 0 ? in.Apply(validation.inputs) : Eigen::MatrixXd(0, train.inputs.cols()),
      columns_max);
  OutputLayer layer(out.Apply(train.targets), units, options);
  layer.Draw(units.columns, random);

  std::vector<float> hidden_weights;
  Eigen::MatrixXd best_weights;
  double best_mse = std::numeric_limits<double>::infinity();
  double best_marked = best_mse;  // The last improvement that was large enough to go on for.
  int best_hidden = 0, marked_hidden = 0, epochs = 0;
  bool goal_reached = false;
  for (int hidden = 0;; ++hidden) {
    epochs += layer.Train(units);
    const Eigen::MatrixXd weights = layer.Weights();
    const double train_mse = Mse(units, weights, out, train.targets, options.outputs);
    const double judged = validation.rows() > 0
                              ? Mse(held_out, weights, out, validation.targets, options.outputs)
                              : train_mse;
    goal_reached = layer.AllNear() || train_mse <= options.mse_goal;
    if (judged < best_mse || goal_reached) {
      best_mse = judged;
      best_weights = weights;
      best_hidden = hidden;
    }
    if (judged < (1 - options.improvement) * best_marked) {
      best_marked = judged;
      marked_hidden = hidden;
    }
    const bool stagnates = validation.rows() > 0 && hidden - marked_hidden >= options.patience;
    if (goal_reached || stagnates || hidden == options.hidden_max) break;

    const NewUnit unit = TrainCandidates(layer.Task(units), options.candidates, random);
    epochs += unit.epochs;
    const std::vector<float> row = ToFloats(unit.weights);
    hidden_weights.insert(hidden_weights.end(), row.begin(), row.end());
    units.Add(unit.weights);
    if (validation.rows() > 0) held_out.Add(unit.weights);
    layer.Add(unit);
  }

  const auto inputs = static_cast<std::size_t>(train.inputs.cols());
  const auto kept = static_cast<std::size_t>(best_hidden);
  hidden_weights.resize(cascade::HiddenWeights(inputs, kept));
  Result<cascade::CascadeNetwork> network = cascade::CascadeNetwork::Create(
      {.inputs = inputs,
       .hidden = kept,
       .outputs = static_cast<std::size_t>(outputs),
       .sigmoid_outputs = options.outputs == Outputs::kSigmoid,
       .input_mean = ToFloats(in.mean),
       .input_scale = ToFloats(in.scale),
       .hidden_weights = hidden_weights,
       .output_weights = ToFloats(best_weights),  // Column by column: a row of the network each.
       .output_mean = ToFloats(out.mean),
       .output_scale = ToFloats(out.scale.cwiseInverse())},
      "trained cascade");
  FOOTING_CHECK(network.ok());
  CascadeResult result{.network = *network,
                       .hidden_units = best_hidden,
                       .epochs = epochs,
                       .train_mse = MeanSquaredError(*network, train),
                       .validation_mse = MeanSquaredError(*network, validation),
                       .goal_reached = goal_reached};
  return result;
}

}  // namespace footing::learning
