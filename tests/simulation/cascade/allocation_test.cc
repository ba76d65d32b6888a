#include <gtest/gtest.h>

#include <array>
#include <memory>

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

}  // namespace
}  // namespace footing::cascade
