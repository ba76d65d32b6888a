#include "daemon/simulation/biped/box.h"

#include <cmath>
#include <numbers>

#include "daemon/simulation/biped/ground.h"
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
    const auto height_m = [&](double x_m) {  // Of the upper box, on the centre line.
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

}  // namespace
}  // namespace footing::terrain
