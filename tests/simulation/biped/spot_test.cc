#include "daemon/simulation/biped/spot.h"

#include <gtest/gtest.h>

#include <cmath>

#include "daemon/simulation/biped/ground.h"
#include "daemon/simulation/biped/track.h"

namespace footing::terrain {
namespace {

/// 5 m level, 3 m raised by 0.1, 4 m uphill at 5 degrees, a pit of 1 m, 2 m behind it.
stream::Track Mixed() {
  Result<stream::Track> track = ParseTrack(
      R"({"version":1,"name":"mixed","segments":[{"length_m":5},{"length_m":3,"step_m":0.1},
          {"length_m":4,"slope_deg":5},{"length_m":1,"pit":true},{"length_m":2}]})",
      "test");
  EXPECT_TRUE(track.ok());
  return std::move(track).value();
}

TEST(Spot, KnowsTheStepsBeforeAndBehind) {
  const Spot below = Survey(Mixed(), 4.8, 0.5);
  EXPECT_EQ(below.height_m, 0);
  EXPECT_TRUE(std::isinf(below.behind.distance_m));  // The track's start is no edge.
  EXPECT_NEAR(below.ahead.distance_m, 0.2, 1e-12);
  EXPECT_NEAR(below.ahead.rise_m, 0.1, 1e-12);

  const Spot above = Survey(Mixed(), 5.3, -0.5);
  EXPECT_NEAR(above.height_m, 0.1, 1e-12);
  EXPECT_NEAR(above.behind.distance_m, 0.3, 1e-12);
  EXPECT_NEAR(above.behind.rise_m, 0.1, 1e-12);
}

TEST(Spot, TakesTheStartOfASlopeForNoEdge) {
  const Spot before = Survey(Mixed(), 7.9, 0);
  EXPECT_TRUE(std::isinf(before.ahead.distance_m));
  const Spot on = Survey(Mixed(), 9, 0);
  EXPECT_NEAR(on.slope, std::tan(5 * M_PI / 180), 1e-12);
  EXPECT_NEAR(on.height_m, 0.1 + on.slope * 1, 1e-12);
  EXPECT_TRUE(std::isinf(on.behind.distance_m));
}

TEST(Spot, TellsAPitsEdgesFromSteps) {
  const double slope_end_m = 8 + 4 * std::cos(5 * M_PI / 180);
  const Spot before = Survey(Mixed(), slope_end_m - 0.5, 0);
  EXPECT_TRUE(before.ahead.pit);
  EXPECT_NEAR(before.ahead.distance_m, 0.5, 1e-9);
  EXPECT_NEAR(before.ahead.rise_m, 0, 1e-9);
  const Spot in = Survey(Mixed(), slope_end_m + 0.5, 0);
  EXPECT_TRUE(in.pit);
  EXPECT_NEAR(in.height_m, 0.1 + 4 * std::sin(5 * M_PI / 180) - kPitDepthM, 1e-9);
}

}  // namespace
}  // namespace footing::terrain
