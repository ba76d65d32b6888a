#include <array>
#include <cmath>
#include <limits>
#include <memory>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "daemon/simulation/cascade/network.h"
#include "tests/simulation/allocations.h"

namespace footing::cascade {
namespace {

TEST(CascadeNetwork, EvaluatesWithoutAllocating) {
  if (!test::CountsAllocations()) GTEST_SKIP() << "the sanitizer owns malloc";
  NetworkWeights weights{.inputs = 20,
                         .hidden = 40,
                         .outputs = 2,
                         .sigmoid_outputs = false,
                         .input_mean = std::vector<float>(20, 0),
                         .input_scale = std::vector<float>(20, 1),
                         .hidden_weights = std::vector<float>(HiddenWeights(20, 40), 0.01f),
                         .output_weights = std::vector<float>(2 * 61, 0.1f),
                         .output_mean = {0, 0},
                         .output_scale = {1, 1}};
  const CascadeNetwork network = CascadeNetwork::Create(weights, "").value();
  long before = test::Allocations();
  auto probe = std::make_unique<int>(1);
  ASSERT_GT(test::Allocations(), before) << "the counter does not count";
  std::array<float, 20> inputs{};
  std::array<float, 2> outputs{};
  before = test::Allocations();
  for (int i = 0; i < 1000; ++i) {
    inputs[0] = outputs[0];
    ASSERT_TRUE(network.Evaluate(inputs, outputs));
  }
  EXPECT_EQ(test::Allocations(), before);
}

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

/// Two inputs, two hidden units, two outputs, every weight another number.
NetworkWeights Example() {
  return {.inputs = 2,
          .hidden = 2,
          .outputs = 2,
          .sigmoid_outputs = false,
          .input_mean = {1, -2},
          .input_scale = {2, 0.5},
          .hidden_weights = {0.1f, -0.4f, 0.7f, /* unit 2 */ -0.2f, 0.3f, 0.9f, -1.5f},
          .output_weights = {0.5f, 1, -1, 2, -3, /* output 2 */ 0.25f, 0, 0.5f, -0.75f, 1},
          .output_mean = {10, 20},
          .output_scale = {4, 0.1f}};
}

double Sigmoid(double x) { return 1 / (1 + std::exp(-x)) - 0.5; }

std::string Refusal(NetworkWeights weights) {
  const auto network = CascadeNetwork::Create(std::move(weights), "m.fmodel");
  return network.ok() ? "" : network.error().message;
}

TEST(CascadeNetwork, EveryHiddenUnitSeesBiasInputsAndTheUnitsBefore) {
  const CascadeNetwork network = CascadeNetwork::Create(Example(), "").value();
  const std::array<float, 2> inputs = {1.5f, 3};
  std::array<float, 2> outputs;
  ASSERT_TRUE(network.Evaluate(inputs, outputs));
  const double a = (1.5 - 1) * 2, b = (3.0 + 2) * 0.5;
  const double h1 = Sigmoid(0.1 - 0.4 * a + 0.7 * b);
  const double h2 = Sigmoid(-0.2 + 0.3 * a + 0.9 * b - 1.5 * h1);
  EXPECT_NEAR(outputs[0], 10 + 4 * (0.5 + a - b + 2 * h1 - 3 * h2), 1e-5);
  EXPECT_NEAR(outputs[1], 20 + 0.1 * (0.25 + 0.5 * b - 0.75 * h1 + h2), 1e-5);
}

TEST(CascadeNetwork, SigmoidOutputsStayWithinHalfAUnit) {
  NetworkWeights weights = Example();
  weights.sigmoid_outputs = true;
  weights.output_mean = {0, 0};
  weights.output_scale = {1, 1};
  const CascadeNetwork network = CascadeNetwork::Create(weights, "").value();
  const std::array<float, 2> inputs = {1.5f, 3};
  std::array<float, 2> outputs;
  ASSERT_TRUE(network.Evaluate(inputs, outputs));
  const double a = 1, b = 2.5, h1 = Sigmoid(0.1 - 0.4 * a + 0.7 * b);
  const double h2 = Sigmoid(-0.2 + 0.3 * a + 0.9 * b - 1.5 * h1);
  EXPECT_NEAR(outputs[0], Sigmoid(0.5 + a - b + 2 * h1 - 3 * h2), 1e-6);
}

TEST(CascadeNetwork, WithoutHiddenUnitsIsLinear) {
  NetworkWeights weights = Example();
  weights.hidden = 0;
  weights.hidden_weights.clear();
  weights.output_weights = {0.5f, 1, -1, 0.25f, 0, 0.5f};
  const CascadeNetwork network = CascadeNetwork::Create(weights, "").value();
  std::array<float, 2> values = {1.5f, 3};
  ASSERT_TRUE(network.Evaluate(values, values)) << "outputs may take the inputs' place";
  EXPECT_NEAR(values[0], 10 + 4 * (0.5 + 1 - 2.5), 1e-5);
}

TEST(CascadeNetwork, GivesItsMeanOfNumbersThatAreNotFinite) {
  NetworkWeights weights = Example();
  weights.sigmoid_outputs = true;  // A sigmoid makes a finite number of an infinite one.
  const CascadeNetwork network = CascadeNetwork::Create(weights, "").value();
  for (const float bad :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    std::array<float, 2> outputs;
    EXPECT_FALSE(network.Evaluate(std::array<float, 2>{bad, 0}, outputs));
    EXPECT_EQ(outputs, (std::array<float, 2>{10, 20}));
  }
  weights.sigmoid_outputs = false;
  const CascadeNetwork linear = CascadeNetwork::Create(weights, "").value();
  std::array<float, 2> outputs;
  EXPECT_FALSE(linear.Evaluate(std::array<float, 2>{3e38f, 0}, outputs)) << "overflows inside";
  EXPECT_EQ(outputs, (std::array<float, 2>{10, 20}));
}

TEST(CascadeNetwork, WithAWrongNumberOfNumbersIsRefusedByTheirName) {
  for (const auto part : {&NetworkWeights::input_mean, &NetworkWeights::input_scale,
                          &NetworkWeights::hidden_weights, &NetworkWeights::output_weights,
                          &NetworkWeights::output_mean, &NetworkWeights::output_scale}) {
    NetworkWeights weights = Example();
    (weights.*part).push_back(1);
    EXPECT_THAT(Refusal(weights), HasSubstr("numbers where"));
    weights = Example();
    (weights.*part).pop_back();
    EXPECT_THAT(Refusal(weights), HasSubstr("numbers where"));
    weights = Example();
    (weights.*part)[0] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THAT(Refusal(weights), HasSubstr("not finite"));
  }
}

TEST(CascadeNetwork, OfASizeThatNothingCanHaveIsRefused) {
  for (const auto size :
       {&NetworkWeights::inputs, &NetworkWeights::hidden, &NetworkWeights::outputs}) {
    NetworkWeights weights = Example();
    weights.*size = 1000;
    EXPECT_THAT(Refusal(weights), HasSubstr("m.fmodel: a cascade of "));
  }
  NetworkWeights weights = Example();
  weights.inputs = 0;
  EXPECT_THAT(Refusal(weights), HasSubstr("0 inputs"));
}

}  // namespace
}  // namespace footing::cascade
