#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "common/model/model.h"
#include "daemon/offline/learning/pose_regression.h"

/// Trainers of small networks. The same examples, options and seed give the same bits.
namespace footing::learning {

/// Training data: row p of `inputs` gives row p of `targets`, in the data's own units.
struct Examples {
  Eigen::MatrixXd inputs;
  Eigen::MatrixXd targets;

  Eigen::Index rows() const { return inputs.rows(); }
};

/// Training and validation, split in time: neighbours in a recording are nearly equal, so that rows
/// drawn at random would test a network by what it learned from.
struct Split {
  Examples train, validation;
};

/// The last `fraction` of the rows, in [0, 1), is for validation.
Split SplitInTime(const Examples& all, double fraction);

/// The rows of all, one after the other. At least one; equal columns.
Examples Joined(const std::vector<const Examples*>& parts);

/// Noise on inputs that are the network's own earlier outputs in use. A network trained on perfect
/// ones goes on from its first error to the end of the world (closed loop, pose paper, section 4.2:
/// the COM positions); one trained with noise learns to come back.
struct FeedbackNoise {
  /// Columns of one signal at several instants, a group each: an estimate that is wrong is wrong by
  /// nearly the same at each of them.
  std::vector<std::vector<Eigen::Index>> groups;
  double common_sd = 0;  ///< Error that a row's group shares, in the inputs' unit.
  double own_sd = 0;     ///< Each column's own error besides.
  int copies = 1;        ///< Copies of every row, each with other noise.
};

/// The rows with noise on their inputs; targets stay true. Without groups, the rows as they are.
Examples WithFeedbackNoise(const Examples& examples, const FeedbackNoise& noise,
                           std::uint64_t seed);

/// A perceptron with one layer of hidden units s(x) = 1 / (1 + exp(-x)) - 1/2 and linear outputs:
/// what cascade correlation is compared with. Inputs and targets are scaled as the cascade's are.
struct Mlp {
  Scaling input_scaling, output_scaling;
  Eigen::MatrixXd hidden_weights;  ///< Hidden x (1 + inputs); the first column is the bias.
  Eigen::MatrixXd output_weights;  ///< Outputs x (1 + hidden).

  /// In the data's units, a row each.
  Eigen::MatrixXd Evaluate(const Eigen::MatrixXd& inputs) const;
};

/// Mean over rows and outputs of the squared error, in the targets' unit squared.
double MeanSquaredError(const Mlp& network, const Examples& examples);

/// Appends input_mean, input_scale, hidden_weights, output_weights, output_mean, output_scale.
void AppendTensors(const Mlp& network, model::Model& model);

/// Half the mean squared error of scaled rows, and its derivatives: back-propagation.
struct MlpGradient {
  double error = 0;
  Eigen::MatrixXd hidden_weights, output_weights;
};
MlpGradient Gradient(const Mlp& network, const Eigen::MatrixXd& scaled_inputs,
                     const Eigen::MatrixXd& scaled_targets);

/// Options of the training of a network with one hidden layer.
struct MlpOptions {
  int hidden = 20;
  double rate = 0.05;     ///< Step along the mean gradient of a batch of scaled rows.
  double momentum = 0.9;  ///< Part of the last step that goes on.
  int batch = 16;
  int epochs_max = 500;
  /// Stops at a mean squared error of validation (of training without validation rows) at or below
  /// this: how long back-propagation takes to an equal error.
  double mse_goal = 0;
  int patience = 100;  ///< Epochs without a better error, then it stops.
};

/// A trained network with its mean squared errors.
struct MlpResult {
  Mlp network;  ///< Network of the best epoch.
  int epochs = 0;
  double train_mse = 0;
  double validation_mse = 0;  ///< 0 without validation rows.
  bool goal_reached = false;
};

/// Back-propagation with momentum over batches drawn again each epoch.
MlpResult TrainMlp(const Examples& train, const Examples& validation, const MlpOptions& options,
                   std::uint64_t seed);

/// Two interlocking spirals of three turns (Lang & Witbrock 1988, as Fahlman & Lebiere used them):
/// 194 points (x, y) within 6.5 -> +-1/2. With `denser` > 1, that many times as many points along
/// the same spirals.
Examples TwoSpirals(int denser = 1);

}  // namespace footing::learning
