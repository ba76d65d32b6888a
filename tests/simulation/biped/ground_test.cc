#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "daemon/simulation/biped/ground.h"
#include "daemon/simulation/biped/track.h"
#include "tests/simulation/test_world.h"

namespace footing::terrain {
namespace {

bool IsIn(const GroundBox& box, const Eigen::Vector3d& p_W_m) {
  const Eigen::Array3d p_S = (box.q_WS.inverse() * (p_W_m - box.centre_W_m)).array();
  return (p_S.abs() <= box.half_size_m.array() + 1e-9).all();
}

TEST(GroundBox, LeavesNoWedgeOpenWhereTheTrackTurns) {
  for (const double turn_deg : {-30.0, -15.0, 5.0, 15.0, 90.0}) {
    const std::string text =
        R"({"version": 1, "segments": [{"length_m": 5}, {"length_m": 5, "curve_deg": )" +
        std::to_string(turn_deg) + "}]}";
    const auto track = ParseTrack(text, "bend").value();
    const GroundBox first = BoxOf(track, 0);
    const GroundBox second = BoxOf(track, 1);
    // All around the corner, up to the smaller of both half widths there: on one of the two.
    for (double angle_rad = 0; angle_rad < 2 * std::numbers::pi; angle_rad += 0.05) {
      const double turn_rad = std::fabs(turn_deg) * std::numbers::pi / 180;
      const double radius_m = 2 * std::cos(turn_rad / 2);
      const Eigen::Vector3d p(5 + radius_m * std::cos(angle_rad), radius_m * std::sin(angle_rad),
                              -0.1);
      EXPECT_TRUE(IsIn(first, p) || IsIn(second, p)) << turn_deg << " degrees, " << angle_rad;
    }
  }
}

TEST(GroundBox, BeginsAStepInATurnWhereTheTrackHasIt) {
  for (const double step_m : {0.05, -0.05}) {
    const std::string text =
        R"({"version": 1, "segments": [{"length_m": 5}, {"length_m": 5, "curve_deg": 15, "step_m": )" +
        std::to_string(step_m) + "}]}";
    const auto track = ParseTrack(text, "bend").value();
    const GroundBox first = BoxOf(track, 0), second = BoxOf(track, 1);
    const auto height_m = [&](double x_m) {  // Height of the upper box, on the centre line.
      for (double z_m = 0.1; z_m > -0.1; z_m -= 0.005) {
        if (IsIn(first, {x_m, 0, z_m}) || IsIn(second, {x_m, 0, z_m})) return z_m;
      }
      return -1.0;
    };
    EXPECT_NEAR(height_m(4.9), 0, 0.006);
    EXPECT_NEAR(height_m(4.99), 0, 0.006);
    EXPECT_NEAR(height_m(5.01), step_m, 0.006);
    EXPECT_NEAR(height_m(5.1), step_m, 0.006);
    // And no wedge is open on the outer side.
    EXPECT_TRUE(IsIn(first, {5.05, -1, -0.06}) || IsIn(second, {5.05, -1, -0.06}));
  }
}

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
