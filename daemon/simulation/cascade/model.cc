#include "daemon/simulation/cascade/model.h"

#include <array>
#include <cmath>

namespace footing::cascade {
namespace {

struct Part {
  const char* name;
  std::vector<float> NetworkWeights::*numbers;
};

constexpr std::array kParts = {
    Part{"input_mean", &NetworkWeights::input_mean},
    Part{"input_scale", &NetworkWeights::input_scale},
    Part{"hidden_weights", &NetworkWeights::hidden_weights},
    Part{"output_weights", &NetworkWeights::output_weights},
    Part{"output_mean", &NetworkWeights::output_mean},
    Part{"output_scale", &NetworkWeights::output_scale},
};

/// 0 when it is none of the whole numbers from 0 to 1000: Create then refuses it.
std::size_t Size(float value) {
  return value >= 0 && value <= 1000 && value == std::floor(value) ? static_cast<std::size_t>(value)
                                                                   : 0;
}

}  // namespace

void AppendTensors(const CascadeNetwork& network, const std::string& prefix, model::Model& model) {
  const NetworkWeights& w = network.weights();
  model.tensors.push_back(
      {.name = prefix + "sizes",
       .shape = {4},
       .values = {static_cast<float>(w.inputs), static_cast<float>(w.hidden),
                  static_cast<float>(w.outputs), w.sigmoid_outputs ? 1.f : 0.f}});
  for (const Part& part : kParts) {
    const std::vector<float>& numbers = w.*part.numbers;
    if (numbers.empty()) continue;  // A cascade without hidden units.
    model.tensors.push_back({.name = prefix + part.name,
                             .shape = {static_cast<std::uint32_t>(numbers.size())},
                             .values = numbers});
  }
}

Result<CascadeNetwork> FromTensors(const model::Model& model, const std::string& prefix,
                                   const std::string& origin) {
  const Result<const model::Tensor*> sizes = model::Find(model, prefix + "sizes", {4}, origin);
  if (!sizes) return sizes.error();
  const std::vector<float>& values = (*sizes)->values;
  if (values[1] != static_cast<float>(Size(values[1]))) {
    return InvalidData(origin + ": " + prefix + "sizes holds no whole number of hidden units");
  }
  NetworkWeights weights;
  weights.inputs = Size(values[0]);
  weights.hidden = Size(values[1]);
  weights.outputs = Size(values[2]);
  weights.sigmoid_outputs = values[3] != 0;
  for (const Part& part : kParts) {
    if (const model::Tensor* tensor = model::FindAny(model, prefix + part.name)) {
      weights.*part.numbers = tensor->values;
    }
  }
  return CascadeNetwork::Create(std::move(weights), origin);
}

}  // namespace footing::cascade
