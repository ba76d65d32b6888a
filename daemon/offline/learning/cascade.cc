#include "daemon/offline/learning/cascade.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "common/base/result.h"
#include "daemon/offline/learning/pose_regression.h"

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
  /// The best of a new pool.
  NewUnit Candidate(const Units& units, noise::Random& random) const {
    const CandidateOptions& options = options_.candidates;
    if (options_.outputs == Outputs::kLinear && options_.objective == Objective::kErrorReduction) {
      return TrainCandidates(
          CandidateTask<double>::ErrorReduction(units.used(), errors(), solver_.basis()), options,
          random);
    }
    return TrainCandidates(CandidateTask<float>::Covariance(units.used(), errors()), options,
                           random);
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

/// Linear outputs learn targets of mean 0 and standard deviation 1; sigmoid ones the targets.
Scaling ScalingOfTargets(const Eigen::MatrixXd& targets, Outputs outputs) {
  if (outputs != Outputs::kLinear) return Scaling::None(targets.cols());
  Scaling scaling = Scaling::Of(targets);
  scaling.scale = (scaling.scale.array() > 0).select(scaling.scale, 1);
  return scaling;
}

/// The network to go back to, and whether more hidden units still pay.
class BestSoFar {
 public:
  /// The outputs over `hidden` units. A network that reaches the goal is taken in any case.
  void Add(int hidden, double mse, const Eigen::MatrixXd& weights, bool goal_reached,
           double improvement) {
    if (mse < mse_ || goal_reached) {
      mse_ = mse;
      weights_ = weights;
      hidden_ = hidden;
    }
    if (mse < (1 - improvement) * improved_mse_) {
      improved_mse_ = mse;
      improved_hidden_ = hidden;
    }
  }

  int hidden() const { return hidden_; }
  const Eigen::MatrixXd& weights() const { return weights_; }  ///< A column for each output.
  /// Units added since the last improvement that was large enough to go on for.
  int WithoutImprovement(int hidden) const { return hidden - improved_hidden_; }

 private:
  Eigen::MatrixXd weights_;
  int hidden_ = 0;
  double mse_ = std::numeric_limits<double>::infinity();
  int improved_hidden_ = 0;
  double improved_mse_ = std::numeric_limits<double>::infinity();
};

cascade::CascadeNetwork ToNetwork(const BestSoFar& best, std::vector<float> hidden_weights,
                                  const Scaling& in, const Scaling& out, Outputs outputs) {
  const auto inputs = static_cast<std::size_t>(in.mean.size());
  const auto hidden = static_cast<std::size_t>(best.hidden());
  hidden_weights.resize(cascade::HiddenWeights(inputs, hidden));
  Result<cascade::CascadeNetwork> network = cascade::CascadeNetwork::Create(
      {.inputs = inputs,
       .hidden = hidden,
       .outputs = static_cast<std::size_t>(out.mean.size()),
       .sigmoid_outputs = outputs == Outputs::kSigmoid,
       .input_mean = ToFloats(in.mean),
       .input_scale = ToFloats(in.scale),
       .hidden_weights = std::move(hidden_weights),
       .output_weights = ToFloats(best.weights()),  // Column by column: a row of the network each.
       .output_mean = ToFloats(out.mean),
       .output_scale = ToFloats(out.scale.cwiseInverse())},
      "trained cascade");
  FOOTING_CHECK(network.ok());
  return *network;
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
  FOOTING_CHECK(options.hidden_min <= options.hidden_max);
  noise::Random random(seed);
  const Scaling in = Scaling::Of(train.inputs);
  const Scaling out = ScalingOfTargets(train.targets, options.outputs);
  const Eigen::Index columns_max = 1 + train.inputs.cols() + options.hidden_max;
  Units units(in.Apply(train.inputs), columns_max);
  Units held_out(
      validation.rows() > 0 ? in.Apply(validation.inputs) : Eigen::MatrixXd(0, train.inputs.cols()),
      columns_max);
  OutputLayer layer(out.Apply(train.targets), units, options);
  layer.Draw(units.columns, random);

  std::vector<float> hidden_weights;
  BestSoFar best;
  int epochs = 0;
  bool goal_reached = false;
  for (int hidden = 0;; ++hidden) {
    epochs += layer.Train(units);
    const Eigen::MatrixXd weights = layer.Weights();
    const double train_mse = Mse(units, weights, out, train.targets, options.outputs);
    const bool validates = validation.rows() > 0;
    const double mse =
        validates ? Mse(held_out, weights, out, validation.targets, options.outputs) : train_mse;
    goal_reached = layer.AllNear() || train_mse <= options.mse_goal;
    const bool enough = hidden >= options.hidden_min;
    if (enough || goal_reached) {
      best.Add(hidden, mse, weights, goal_reached, options.improvement);
    }
    const bool stagnates =
        validates && enough && best.WithoutImprovement(hidden) >= options.patience;
    if (goal_reached || stagnates || hidden == options.hidden_max) break;

    const NewUnit unit = layer.Candidate(units, random);
    epochs += unit.epochs;
    const std::vector<float> row = ToFloats(unit.weights);
    hidden_weights.insert(hidden_weights.end(), row.begin(), row.end());
    units.Add(unit.weights);
    if (validates) held_out.Add(unit.weights);
    layer.Add(unit);
  }

  const auto network = ToNetwork(best, std::move(hidden_weights), in, out, options.outputs);
  return {.network = network,
          .hidden_units = best.hidden(),
          .epochs = epochs,
          .train_mse = MeanSquaredError(network, train),
          .validation_mse = MeanSquaredError(network, validation),
          .goal_reached = goal_reached};
}

namespace {

/// A column's part that is new, over the whole: below it there is nothing but rounding.
constexpr double kLeastNewPart = 1e-10;

}  // namespace

LeastSquares::LeastSquares(const Eigen::MatrixXd& targets, Eigen::Index columns_max)
    : basis_(Eigen::MatrixXd::Zero(targets.rows(), columns_max)),
      triangle_(Eigen::MatrixXd::Zero(columns_max, columns_max)),
      along_(Eigen::MatrixXd::Zero(columns_max, targets.cols())),
      errors_(-targets) {}

void LeastSquares::Add(const Eigen::VectorXd& column) {
  FOOTING_CHECK(columns_ < basis_.cols());
  Eigen::VectorXd rest = column;
  const auto before = basis_.leftCols(columns_);
  for (int time = 0; time < 2; ++time) {
    const Eigen::VectorXd parts = before.transpose() * rest;
    rest.noalias() -= before * parts;
    triangle_.col(columns_).head(columns_) += parts;
  }
  const double size = rest.norm();
  if (size > kLeastNewPart * column.norm()) {
    triangle_(columns_, columns_) = size;
    basis_.col(columns_) = rest / size;
    const Eigen::RowVectorXd along = -basis_.col(columns_).transpose() * errors_;
    along_.row(columns_) = along;
    errors_.noalias() += basis_.col(columns_) * along;
  }
  ++columns_;
}

Eigen::MatrixXd LeastSquares::Weights() const {
  Eigen::MatrixXd weights = Eigen::MatrixXd::Zero(columns_, along_.cols());
  for (Eigen::Index row = columns_ - 1; row >= 0; --row) {
    if (triangle_(row, row) == 0) continue;
    const Eigen::Index later = columns_ - 1 - row;
    weights.row(row) =
        (along_.row(row) - triangle_.row(row).segment(row + 1, later) * weights.bottomRows(later)) /
        triangle_(row, row);
  }
  return weights;
}

}  // namespace footing::learning
