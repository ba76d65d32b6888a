#include "daemon/offline/eval/transitions.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/base/units.h"

namespace footing::eval {
namespace {

using stream::Gait;

TransitionResult FromRun(Gait to) {
  const TransitionSpeeds speeds{.from_mps = 2.5, .to_mps = 1, .height_m = 0.3};
  const auto result = RunTransition(Gait::kRun, to, 77, speeds);
  EXPECT_TRUE(result.ok());
  return result.value();
}

TEST(Transition, ReportsTheFirstLeapOfAJump) {
  const TransitionResult result = FromRun(Gait::kJump);
  ASSERT_TRUE(result.leap);
  EXPECT_EQ(result.leap->commanded_m, 0.3);
  EXPECT_NEAR(result.leap->rise_m, 0.3, 0.06);
  // Up and down again, without what the COM at touchdown lies lower or higher than at lift-off.
  EXPECT_NEAR(result.leap->flight_s, 2 * std::sqrt(2 * 0.3 / kStandardGravityMps2), 0.1);
  // At the speed of the run that it leapt from.
  EXPECT_NEAR(result.leap->length_m / result.leap->flight_s, 2.5, 0.4);
}

TEST(Transition, HasNoLeapWithoutAJump) { EXPECT_FALSE(FromRun(Gait::kWalk).leap); }

}  // namespace
}  // namespace footing::eval
