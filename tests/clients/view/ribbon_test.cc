#include "clients/view/scene/ribbon.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "common/base/units.h"
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

/// A track of straight pieces that turn to the left.
stream::Track Bend(int count, double length_m, double turn_rad) {
  stream::Track track = made::StraightTrack(length_m);
  for (int i = 1; i < count; ++i) {
    stream::TrackSegment next = track.segments.back();
    next.start_m +=
        next.length_m * Eigen::Vector3d(std::cos(next.heading_rad), std::sin(next.heading_rad), 0);
    next.heading_rad += turn_rad;
    track.segments.push_back(next);
  }
  return track;
}

/// The quads of the surface: start right, end right, end left, start left.
std::vector<std::array<RibbonVertex, 4>> Surface(const RibbonMesh& mesh) {
  std::vector<std::array<RibbonVertex, 4>> quads;
  for (std::size_t i = 0; i + 3 < mesh.vertices.size(); i += 4) {
    if (mesh.vertices[i].kind != 0) continue;
    quads.push_back(
        {mesh.vertices[i], mesh.vertices[i + 1], mesh.vertices[i + 2], mesh.vertices[i + 3]});
  }
  return quads;
}

TEST(Ribbon, NeighboursShareTheirCornersToTheLastBit) {
  const auto quads = Surface(BuildRibbon(Bend(12, 1.7, 0.17)));
  ASSERT_GT(quads.size(), 12u);
  for (std::size_t i = 1; i < quads.size(); ++i) {
    EXPECT_EQ(quads[i - 1][1].position, quads[i][0].position) << i;
    EXPECT_EQ(quads[i - 1][2].position, quads[i][3].position) << i;
    EXPECT_EQ(quads[i - 1][1].along_m, quads[i][0].along_m) << i;
  }
  EXPECT_EQ(HeightAt(Bend(2, 10, 0.5), {8.2, -1.5}, -1), 0) << "outside of the bend";
}

TEST(Ribbon, NoWallStandsAcrossTheTrackBetweenNeighbours) {
  int across = 0;
  const RibbonMesh mesh = BuildRibbon(Bend(12, 1.7, 0.17));
  for (std::size_t i = 0; i + 3 < mesh.vertices.size(); i += 4) {
    const RibbonVertex &a = mesh.vertices[i], &b = mesh.vertices[i + 1];
    across += a.kind == 2 && (a.position - b.position).norm() > 3.5f ? 1 : 0;
  }
  EXPECT_EQ(across, 2) << "only at the start and at the end";
}

TEST(Ribbon, ABendIsACurveNearTheTrackThatIsWalkedOn) {
  // Two degrees at most between two pieces, where the track turns by ten.
  const auto quads = Surface(BuildRibbon(Bend(12, 1.7, 0.17)));
  const auto ahead = [](const std::array<RibbonVertex, 4>& quad) -> Eigen::Vector3f {
    return (quad[1].position + quad[2].position - quad[0].position - quad[3].position).normalized();
  };
  for (std::size_t i = 1; i < quads.size(); ++i) {
    const float turn = std::acos(std::min(1.0f, ahead(quads[i - 1]).dot(ahead(quads[i]))));
    EXPECT_LT(turn, static_cast<float>(DegreesToRadians(2))) << i;
  }
  // A corner of ten degrees, cut 0.85 m before it: a quarter of 2 x 0.85 tan(5 degrees) = 4 cm.
  const stream::Track track = Bend(2, 1.7, 0.17);
  const Eigen::Vector3f corner = track.segments[1].start_m.cast<float>();
  float nearest = 1e9f;
  for (const auto& quad : Surface(BuildRibbon(track))) {
    nearest = std::min(nearest, ((quad[1].position + quad[2].position) / 2 - corner).norm());
  }
  EXPECT_NEAR(nearest, 0.85 * std::tan(0.085) / 2, 0.005);
}

TEST(Ribbon, AnEndlessTrackGoesOnAndFades) {
  stream::Track track = made::StraightTrack(30);
  EXPECT_EQ(FadeOf(track).to_m, 0);
  track.endless = true;
  track.first_m = 100;
  const Fade fade = FadeOf(track);
  EXPECT_EQ(fade.from_m, 130);
  EXPECT_GT(fade.to_m, 150);
  float last = 0;
  for (const auto& quad : Surface(BuildRibbon(track))) last = std::max(last, quad[1].along_m);
  EXPECT_EQ(last, fade.to_m);
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
