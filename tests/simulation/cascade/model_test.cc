#include "daemon/simulation/cascade/model.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace footing::cascade {
namespace {

using testing::HasSubstr;

CascadeNetwork Example(std::size_t hidden, float first_weight) {
  NetworkWeights weights{.inputs = 1,
                         .hidden = hidden,
                         .outputs = 1,
                         .sigmoid_outputs = true,
                         .input_mean = {1},
                         .input_scale = {2},
                         .hidden_weights = std::vector<float>(HiddenWeights(1, hidden), 0.5f),
                         .output_weights = std::vector<float>(2 + hidden, 0.25f),
                         .output_mean = {3},
                         .output_scale = {4}};
  weights.output_weights[0] = first_weight;
  return CascadeNetwork::Create(weights, "").value();
}

model::Model ModelOf(const CascadeNetwork& network, const std::string& prefix) {
  model::Model model{.kind = "cascade", .provenance = {}, .tensors = {}};
  AppendTensors(network, prefix, model);
  return model;
}

TEST(CascadeModel, HoldsSeveralNetworksBehindTheirPrefixes) {
  model::Model model = ModelOf(Example(2, 7), "x.");
  AppendTensors(Example(0, 8), "y.", model);
  ASSERT_TRUE(model::Check(model, "m").ok());
  const auto x = FromTensors(model, "x.", "m");
  const auto y = FromTensors(model, "y.", "m");
  ASSERT_TRUE(x.ok() && y.ok());
  EXPECT_EQ(x->weights().hidden, 2u);
  EXPECT_EQ(x->weights().hidden_weights, Example(2, 7).weights().hidden_weights);
  EXPECT_EQ(x->weights().output_weights, Example(2, 7).weights().output_weights);
  EXPECT_EQ(y->weights().hidden, 0u);
  EXPECT_EQ(y->weights().output_weights[0], 8);
  EXPECT_TRUE(y->weights().sigmoid_outputs);
  EXPECT_FALSE(FromTensors(model, "z.", "m").ok());
}

TEST(CascadeModel, WithoutOneOfItsTensorsIsRefused) {
  const model::Model whole = ModelOf(Example(2, 7), "");
  for (std::size_t i = 0; i < whole.tensors.size(); ++i) {
    model::Model model = whole;
    model.tensors.erase(model.tensors.begin() + static_cast<std::ptrdiff_t>(i));
    EXPECT_FALSE(FromTensors(model, "", "m").ok()) << whole.tensors[i].name;
  }
}

TEST(CascadeModel, WithSizesThatAreNoSizesIsRefused) {
  for (std::size_t i = 0; i < 3; ++i) {
    for (const float bad : {-1.f, 1.5f, 1e30f, std::numeric_limits<float>::quiet_NaN()}) {
      model::Model model = ModelOf(Example(2, 7), "");
      model.tensors[0].values[i] = bad;
      EXPECT_FALSE(FromTensors(model, "", "m").ok()) << i << " " << bad;
    }
  }
}

}  // namespace
}  // namespace footing::cascade
