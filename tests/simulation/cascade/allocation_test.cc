#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <memory>

#include "daemon/simulation/cascade/network.h"

// Counts what malloc hands out; a sanitizer brings its own.
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define FOOTING_COUNTS_ALLOCATIONS 1
namespace {
long allocations = 0;
}
extern "C" {
void* __libc_malloc(std::size_t);
void* malloc(std::size_t size) {
  ++allocations;
  return __libc_malloc(size);
}
}
#endif

namespace footing::cascade {
namespace {

TEST(CascadeNetwork, EvaluatesWithoutAllocating) {
#ifndef FOOTING_COUNTS_ALLOCATIONS
  GTEST_SKIP() << "the sanitizer owns malloc";
#else
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
  long before = allocations;
  auto probe = std::make_unique<int>(1);
  ASSERT_GT(allocations, before) << "the counter does not count";
  std::array<float, 20> inputs{};
  std::array<float, 2> outputs{};
  before = allocations;
  for (int i = 0; i < 1000; ++i) {
    inputs[0] = outputs[0];
    ASSERT_TRUE(network.Evaluate(inputs, outputs));
  }
  EXPECT_EQ(allocations, before);
#endif
}

}  // namespace
}  // namespace footing::cascade
