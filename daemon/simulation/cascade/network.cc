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

}  // namespace footing::cascade
