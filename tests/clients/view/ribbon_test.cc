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

TEST(Ribbon, TheLinesOfATrialArePaintedWhereTheTrackHasThem) {
  stream::Track track = made::StraightTrack(66);  // From x = -2.
  track.start_m = 1;
  track.finish_m = 60;
  track.mark_m = 30;
  const auto quads_at = [](const RibbonMesh& mesh, float x, float kind) {
    int count = 0;
    for (std::size_t i = 0; i + 3 < mesh.vertices.size(); i += 4) {
      const RibbonVertex& low = mesh.vertices[i];
      const float middle = (low.position.x() + mesh.vertices[i + 1].position.x()) / 2;
      count += low.kind == kind && std::abs(middle - x) < 0.2f ? 1 : 0;
    }
    return count;
  };
  const RibbonMesh course = BuildRibbon(track);
  EXPECT_EQ(quads_at(course, -1, 3), 1);   // The start line.
  EXPECT_GE(quads_at(course, 58, 3), 12);  // The finish line: half of two rows of 14 squares.
  EXPECT_EQ(quads_at(course, 28, 4), 0);   // Without a task the mark means nothing.
  track.tasks.resize(1);
  const RibbonMesh straight = BuildRibbon(track);
  EXPECT_EQ(quads_at(straight, 28, 4), 1);
  EXPECT_EQ(quads_at(straight, 31, 3), 1);  // The line to follow: one over the whole length.
}

TEST(Ribbon, NumbersGoOnWhereTheStartWasDropped) {
  stream::Track track = made::StraightTrack(8);
  track.first_m = 495;
  const RibbonMesh mesh = BuildRibbon(track);
  EXPECT_EQ(std::count_if(mesh.vertices.begin(), mesh.vertices.end(),
                          [](const RibbonVertex& v) { return v.kind == 3; }),
            static_cast<long>(4 * PaintNumber("500").size()));
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

TEST(Ribbon, SegmentsMeetWithoutAGapWhereTheTrackTurns) {
  stream::Track track = made::StraightTrack(10);
  stream::TrackSegment& first = track.segments.front();
  stream::TrackSegment turned = first;
  turned.start_m = first.start_m + Eigen::Vector3d(10, 0, 0);
  turned.heading_rad = 0.5;
  track.segments.push_back(turned);
  const RibbonMesh mesh = BuildRibbon(track);
  // The first four vertices of a segment are its face: start right, end right, end left, start
  // left.
  const auto face = [&mesh](float from_m) {
    std::vector<Eigen::Vector3f> corners;
    for (const RibbonVertex& v : mesh.vertices) {
      if (v.kind == 0 && v.along_m > from_m - 1.2f && v.along_m < from_m + 1.2f) {
        corners.push_back(v.position);
      }
    }
    return corners;
  };
  const auto joint = face(10);
  ASSERT_EQ(joint.size(), 4u);
  EXPECT_LT((joint[0] - joint[2]).norm(), 1e-5f);  // Right: end of the first, start of the second.
  EXPECT_LT((joint[1] - joint[3]).norm(), 1e-5f);  // Left.
  // Just outside the bend, where the gap was.
  EXPECT_EQ(HeightAt(track, {8.2, -1.5}, -1), 0);
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
