#include "daemon/offline/analysis/leg_gap.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/virtual/devices/noise.h"

namespace footing::legs {
namespace {

using Eigen::Vector3d;

TEST(DistanceBetweenSegments, IsThatOfTheirLinesOnlyWhereBothReachThere) {
  const Segment along_x{{-1, 0, 0}, {1, 0, 0}};
  // They cross 0.3 above each other.
  EXPECT_DOUBLE_EQ(DistanceBetween(along_x, {{0.5, -1, 0.3}, {0.5, 1, 0.3}}), 0.3);
  // The other one ends 0.4 before the first: the distance to its end.
  EXPECT_DOUBLE_EQ(DistanceBetween(along_x, {{0.5, 2, 0.3}, {0.5, 0.4, 0.3}}),
                   std::hypot(0.4, 0.3));
  // Both end before they meet: from end to end.
  EXPECT_DOUBLE_EQ(DistanceBetween(along_x, {{2, 2, 0}, {1.3, 0.4, 0}}), 0.5);
  // Parallel, beside each other and one behind the other.
  EXPECT_DOUBLE_EQ(DistanceBetween(along_x, {{-3, 0.2, 0}, {0, 0.2, 0}}), 0.2);
  EXPECT_DOUBLE_EQ(DistanceBetween(along_x, {{3, 0, 0}, {2.5, 0, 0}}), 1.5);
}

TEST(DistanceBetweenSegments, IsTheLeastOfAllPairsOfTheirPoints) {
  noise::Random random(5);
  const auto point = [&random] {
    return Vector3d(random.Uniform(-1, 1), random.Uniform(-1, 1), random.Uniform(-1, 1));
  };
  constexpr int kParts = 200;
  for (int trial = 0; trial < 50; ++trial) {
    const Segment first{point(), point()}, second{point(), point()};
    double least_m = INFINITY;
    for (int i = 0; i <= kParts; ++i) {
      const Vector3d p = first.from_m + i * (first.to_m - first.from_m) / kParts;
      for (int j = 0; j <= kParts; ++j) {
        const Vector3d q = second.from_m + j * (second.to_m - second.from_m) / kParts;
        least_m = std::min(least_m, (p - q).norm());
      }
    }
    // Between two points of the grid it is nearer by less than half of their spacing each.
    const double distance_m = DistanceBetween(first, second);
    EXPECT_LE(distance_m, least_m + 1e-12);
    EXPECT_GT(distance_m, least_m - 3.5 / kParts);
  }
}

TEST(LegGap, IsWhatLiesBetweenTwoLegsOfFourCentimetres) {
  engine::EngineOutput output;
  output.links[1].position_m = {0, 0.1, 0.9};
  output.links[3].position_m = {0, -0.1, 0.9};
  output.contacts[0].position_m = {0, 0.1, 0};
  output.contacts[1].position_m = {0, -0.1, 0};
  EXPECT_NEAR(LegGap(output), 0.16, 1e-12);
  // The right foot beyond the left leg, at one height: they pass through each other.
  output.contacts[1].position_m = {0, 0.2, 0};
  EXPECT_NEAR(LegGap(output), -0.04, 1e-12);
}

}  // namespace
}  // namespace footing::legs
