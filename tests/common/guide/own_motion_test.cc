#include "common/guide/own_motion.h"

#include <gtest/gtest.h>

#include "common/virtual/people/script.h"

namespace footing::guide {
namespace {

TEST(OwnMotion, TheBuiltInChoreographyPerformsItsSteps) {
  const auto script = choreography::BuiltInScript("own_motion");
  ASSERT_TRUE(script.ok()) << script.error().message;
  EXPECT_DOUBLE_EQ(OwnMotionSeconds(), 120);
  EXPECT_NEAR(script->duration_s(), OwnMotionSeconds(), 1e-9);
  // A step begins with a key of the script.
  double step_s = 0, key_s = 0;
  std::size_t key = 0;
  for (const MotionStep& step : OwnMotionSteps()) {
    step_s += step.seconds;
    while (key < script->keys.size() && key_s < step_s - 1e-6) key_s += script->keys[key++].seconds;
    EXPECT_NEAR(key_s, step_s, 1e-6) << step.name;
  }
  EXPECT_TRUE(script->EndsInTPose());
}

}  // namespace
}  // namespace footing::guide
