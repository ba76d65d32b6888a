#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "common/base/result.h"
#include "common/model/model.h"

namespace footing::cascade {

constexpr std::size_t kMostInputs = 256;
constexpr std::size_t kMostHidden = 256;
constexpr std::size_t kMostOutputs = 64;

/// The numbers of a cascade-correlation network (Fahlman & Lebiere 1990, Figure 1; pose paper,
/// section 4.2). With u = (1, scaled inputs, hidden units so far):
///   scaled input i = (input i - input_mean[i]) input_scale[i]
///   hidden unit j  = s(hidden row j . u), s(x) = 1 / (1 + exp(-x)) - 1/2
///   output k       = output_mean[k] + output_scale[k] g(output row k . u), g the identity or s
struct NetworkWeights {
  std::size_t inputs = 0, hidden = 0, outputs = 0;
  bool sigmoid_outputs = false;
  std::vector<float> input_mean, input_scale;
  std::vector<float> hidden_weights;  ///< Row j has 1 + inputs + j; rows follow each other.
  std::vector<float> output_weights;  ///< Rows of 1 + inputs + hidden.
  std::vector<float> output_mean, output_scale;
};

/// Floats in the triangle of a cascade's hidden weights.
constexpr std::size_t HiddenWeights(std::size_t inputs, std::size_t hidden) {
  return hidden * (1 + inputs) + hidden * (hidden - (hidden > 0)) / 2;
}

/// Evaluates; a constant after its making. Copies are values.
class CascadeNetwork {
 public:
  /// Refuses sizes that do not fit, are 0 or too large, and numbers that are not finite. `origin`
  /// names the file.
  static Result<CascadeNetwork> Create(NetworkWeights weights, const std::string& origin);

  /// Units are those of the training data. Allocates nothing; `inputs` and `outputs` have exactly
  /// the network's sizes and may be the same memory. False, and outputs of output_mean, when an
  /// input or a result is not finite.
  bool Evaluate(std::span<const float> inputs, std::span<float> outputs) const;

  const NetworkWeights& weights() const { return weights_; }

 private:
  explicit CascadeNetwork(NetworkWeights weights) : weights_(std::move(weights)) {}

  NetworkWeights weights_;
};

/// Appends the network's tensors, each name behind `prefix` ("x." and "y." where a model holds
/// several): sizes [4] {inputs, hidden, outputs, 1 if outputs are sigmoid}, input_mean,
/// input_scale, hidden_weights, output_weights, output_mean, output_scale.
void AppendTensors(const CascadeNetwork& network, const std::string& prefix, model::Model& model);

/// The network whose tensors stand behind `prefix`, checked; `origin` names the file.
Result<CascadeNetwork> FromTensors(const model::Model& model, const std::string& prefix,
                                   const std::string& origin);

}  // namespace footing::cascade
