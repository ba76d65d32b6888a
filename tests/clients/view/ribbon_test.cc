#include "clients/view/scene/ribbon.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "clients/view/scene/digits.h"
#include "common/units/units.h"
#include "tests/clients/view/made_stream.h"

namespace footing::scene {
namespace {

TEST(Ribbon, TheSurfaceCoversTheSegmentAndNothingElse) {
  const RibbonMesh mesh = BuildRibbon(made::StraightTrack(30));
  float low = 1e9f, high = -1e9f, widest = 0;
  for (const RibbonVertex& vertex : mesh.vertices) {
    if (vertex.kind != 0) continue;
    low = std::min(low, vertex.position.x());
    high = std::max(high, vertex.position.x());
    widest = std::max(widest, std::abs(vertex.position.y()));
  }
  EXPECT_FLOAT_EQ(low, -2);
  EXPECT_FLOAT_EQ(high, 28);
  EXPECT_FLOAT_EQ(widest, 2);
}

TEST(Ribbon, EveryTenthMetreCarriesItsNumber) {
  const RibbonMesh mesh = BuildRibbon(made::StraightTrack(35));
  const auto painted = std::count_if(mesh.vertices.begin(), mesh.vertices.end(),
                                     [](const RibbonVertex& v) { return v.kind == 3; });
  const std::size_t strokes =
      PaintNumber("10").size() + PaintNumber("20").size() + PaintNumber("30").size();
  EXPECT_EQ(painted, static_cast<long>(4 * strokes));
}

TEST(Ribbon, NormalsOfTheSurfacePointUp) {
  stream::Track track = made::StraightTrack(10);
  track.segments[0].slope_rad = DegreesToRadians(5);
  for (const RibbonVertex& vertex : BuildRibbon(track).vertices) {
    if (vertex.kind == 0) {
      EXPECT_NEAR(vertex.normal.z(), std::cos(DegreesToRadians(5)), 1e-6);
    }
  }
}

TEST(HeightAt, FollowsTheSlopeAndLeavesPitsAndTheGroundAlone) {
  stream::Track track = made::StraightTrack(10);
  track.segments[0].slope_rad = DegreesToRadians(5);
  EXPECT_NEAR(HeightAt(track, {3, 1}, -1), 5 * std::tan(DegreesToRadians(5)), 1e-12);
  EXPECT_EQ(HeightAt(track, {3, 2.5}, -1), -1);
  EXPECT_EQ(HeightAt(track, {30, 0}, -1), -1);
  track.segments[0].pit = true;
  EXPECT_EQ(HeightAt(track, {3, 0}, -1), -1);
}

TEST(PaintNumber, AnEightHasAllSevenStrokesAndAOneTwo) {
  EXPECT_EQ(PaintNumber("8").size(), 7u);
  EXPECT_EQ(PaintNumber("1").size(), 2u);
  EXPECT_EQ(PaintNumber("-").size(), 0u);
}

}  // namespace
}  // namespace footing::scene
