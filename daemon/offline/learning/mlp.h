#pragma once

#include <cstdint>
#include <vector>

#include "common/model/model.h"
#include "daemon/offline/learning/examples.h"
#include "daemon/offline/learning/scaling.h"

namespace footing::learning {

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

struct MlpResult {
  Mlp network;  ///< Of the best epoch.
  int epochs = 0;
  double train_mse = 0;
  double validation_mse = 0;  ///< 0 without validation rows.
  bool goal_reached = false;
};

/// Back-propagation with momentum over batches drawn again each epoch.
MlpResult TrainMlp(const Examples& train, const Examples& validation, const MlpOptions& options,
                   std::uint64_t seed);

}  // namespace footing::learning
