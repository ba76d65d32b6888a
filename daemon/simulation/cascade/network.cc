#include "daemon/simulation/cascade/network.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace footing::cascade {
namespace {

constexpr std::size_t kMostUnits = 1 + kMostInputs + kMostHidden;

/// Four sums side by side, which the compiler may keep in one register: order and bits are fixed.
float Dot(const float* a, const float* b, std::size_t size) {
  std::array<float, 4> sums{};
  std::size_t i = 0;
  for (; i + 4 <= size; i += 4) {
    for (std::size_t k = 0; k < 4; ++k) sums[k] += a[i + k] * b[i + k];
  }
  float rest = 0;
  for (; i < size; ++i) rest += a[i] * b[i];
  return (sums[0] + sums[1]) + (sums[2] + sums[3]) + rest;
}

float Sigmoid(float x) { return 1 / (1 + std::exp(-x)) - 0.5f; }

std::string SizesText(const NetworkWeights& w) {
  return std::to_string(w.inputs) + " inputs, " + std::to_string(w.hidden) + " hidden units, " +
         std::to_string(w.outputs) + " outputs";
}

Result<void> CheckNumbers(const std::vector<float>& numbers, std::size_t size, const char* name,
                          const std::string& origin) {
  if (numbers.size() != size) {
    return InvalidData(origin + ": " + name + " has " + std::to_string(numbers.size()) +
                       " numbers where " + std::to_string(size) + " belong");
  }
  const auto finite = [](float value) { return std::isfinite(value); };
  if (!std::all_of(numbers.begin(), numbers.end(), finite)) {
    return InvalidData(origin + ": " + name + " holds a number that is not finite");
  }
  return {};
}

}  // namespace

Result<CascadeNetwork> CascadeNetwork::Create(NetworkWeights weights, const std::string& origin) {
  const NetworkWeights& w = weights;
  if (w.inputs == 0 || w.inputs > kMostInputs || w.hidden > kMostHidden || w.outputs == 0 ||
      w.outputs > kMostOutputs) {
    return InvalidData(origin + ": a cascade of " + SizesText(w) + "; allowed are 1 to " +
                       std::to_string(kMostInputs) + ", up to " + std::to_string(kMostHidden) +
                       ", 1 to " + std::to_string(kMostOutputs));
  }
  struct Part {
    const std::vector<float>& numbers;
    std::size_t size;
    const char* name;
  };
  const std::array parts = {
      Part{w.input_mean, w.inputs, "input_mean"},
      Part{w.input_scale, w.inputs, "input_scale"},
      Part{w.hidden_weights, HiddenWeights(w.inputs, w.hidden), "hidden_weights"},
      Part{w.output_weights, w.outputs * (1 + w.inputs + w.hidden), "output_weights"},
      Part{w.output_mean, w.outputs, "output_mean"},
      Part{w.output_scale, w.outputs, "output_scale"},
  };
  for (const Part& part : parts) {
    if (auto good = CheckNumbers(part.numbers, part.size, part.name, origin); !good) {
      return good.error();
    }
  }
  return CascadeNetwork(std::move(weights));
}

bool CascadeNetwork::Evaluate(std::span<const float> inputs, std::span<float> outputs) const {
  const NetworkWeights& w = weights_;
  FOOTING_CHECK(inputs.size() == w.inputs && outputs.size() == w.outputs);
  std::array<float, kMostUnits> units;
  units[0] = 1;
  std::size_t count = 1;
  bool finite = true;
  for (; count <= w.inputs; ++count) {
    finite = finite && std::isfinite(inputs[count - 1]);
    units[count] = (inputs[count - 1] - w.input_mean[count - 1]) * w.input_scale[count - 1];
  }
  const float* row = w.hidden_weights.data();
  for (std::size_t j = 0; j < w.hidden; ++j) {
    const float unit = Sigmoid(Dot(row, units.data(), count));
    row += count;
    units[count++] = unit;
  }
  for (std::size_t k = 0; k < w.outputs; ++k) {
    const float sum = Dot(w.output_weights.data() + k * count, units.data(), count);
    outputs[k] = w.output_mean[k] + w.output_scale[k] * (w.sigmoid_outputs ? Sigmoid(sum) : sum);
    finite = finite && std::isfinite(outputs[k]);
  }
  if (!finite) std::copy(w.output_mean.begin(), w.output_mean.end(), outputs.begin());
  return finite;
}

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
