#include "daemon/simulation/biped/endless.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/base/units.h"
#include "daemon/simulation/biped/append.h"
#include "tests/simulation/test_world.h"

namespace footing::terrain {
namespace {

stream::Track Endless() {
  return ParseTrack(test::DataFile("tracks/endless.json"), "endless").value();
}

/// A point that moves over an endless track, which continues itself.
struct Wanderer {
  stream::Track track = Endless();
  Eigen::Vector2d p_m = Eigen::Vector2d::Zero(), course = Eigen::Vector2d::Zero();
  double heading_rad = 0, largest_offset_m = 0;

  /// So far, in steps of 2 cm, with a constant turn.
  void Go(double distance_m, double turn_radpm = 0) {
    for (double gone_m = 0; gone_m < distance_m; gone_m += 0.02) {
      heading_rad += 0.02 * turn_radpm;
      const Eigen::Vector2d moved_m =
          0.02 * Eigen::Vector2d(std::cos(heading_rad), std::sin(heading_rad));
      p_m += moved_m;
      FollowCourse(moved_m, course);
      const TrackPlace place = Locate(track, p_m);
      largest_offset_m = std::max(largest_offset_m, place.distance_m);
      if (const auto next = EndlessSegment(track, place, p_m, course)) Add(*next, track);
    }
  }
  double AheadM() const { return LengthOf(track) - LengthTo(track, Locate(track, p_m)); }
};

TEST(EndlessTrack, LiesAheadOfWhoeverGoesStraight) {
  Wanderer wanderer;
  for (int i = 0; i < 100; ++i) {
    wanderer.Go(5);
    EXPECT_GE(wanderer.AheadM(), kEndlessAheadM - 0.02);
    EXPECT_LE(wanderer.AheadM(), kEndlessAheadM + 2.02);
  }
  EXPECT_NEAR(wanderer.largest_offset_m, 0, 1e-6);
}

TEST(EndlessTrack, TurnsWithALastingTurnAndIsNeverFar) {
  Wanderer wanderer;
  wanderer.Go(20);
  wanderer.Go(90, 1.0 / 60);                   // A circle of 60 m radius: 86 degrees.
  EXPECT_LT(wanderer.largest_offset_m, 3.05);  // Half its width, where it begins again.
  const double track_rad = wanderer.track.segments.back().heading_rad;
  EXPECT_NEAR(WrapAngle(track_rad - wanderer.heading_rad), 0, DegreesToRadians(20));
}

TEST(EndlessTrack, BendsByFifteenDegreesASegmentAtMost) {
  Wanderer wanderer;
  wanderer.Go(10);
  wanderer.Go(30, 0.15);
  for (std::size_t i = 1; i < wanderer.track.segments.size(); ++i) {
    const auto& before = wanderer.track.segments[i - 1];
    const auto& segment = wanderer.track.segments[i];
    const bool joined = (Following(before).start_m - segment.start_m).norm() < 1e-9;
    const double turn_rad = std::fabs(WrapAngle(segment.heading_rad - before.heading_rad));
    EXPECT_TRUE(!joined || turn_rad <= DegreesToRadians(15) + 1e-9) << i;
  }
}

TEST(EndlessTrack, BeginsAgainUnderWhoeverLeftIt) {
  stream::Track track = Endless();
  const Eigen::Vector2d p_m(4, 10), course(0, 1);
  const auto next = EndlessSegment(track, Locate(track, p_m), p_m, course);
  ASSERT_TRUE(next);
  EXPECT_EQ(next->start_m.head<2>(), p_m);
  EXPECT_NEAR(next->heading_rad, kPi / 2, 1e-12);
  Add(*next, track);
  EXPECT_FALSE(IsOffRibbon(track, Locate(track, p_m)));
}

TEST(EndlessTrack, BeginsAgainOnceUnderWhoeverStandsBesideIt) {
  stream::Track track = Endless();
  const Eigen::Vector2d p_m(4, 10), no_course = Eigen::Vector2d::Zero();
  const double heading_rad = track.segments.back().heading_rad;
  const auto next = EndlessSegment(track, Locate(track, p_m), p_m, no_course);
  ASSERT_TRUE(next);
  EXPECT_EQ(next->start_m.head<2>(), p_m);
  EXPECT_EQ(next->heading_rad, heading_rad);
  Add(*next, track);
  EXPECT_FALSE(IsOffRibbon(track, Locate(track, p_m)));
}

TEST(EndlessTrack, KeepsSixtyFourSegmentsAndTheDistanceOfThoseThatWent) {
  Wanderer wanderer;
  wanderer.Go(500);
  EXPECT_EQ(wanderer.track.segments.size(), kMostEndlessSegments);
  EXPECT_NEAR(LengthTo(wanderer.track, Locate(wanderer.track, wanderer.p_m)), 500, 0.03);
}

TEST(Course, IsTheDirectionOfTheLastTenMetres) {
  Eigen::Vector2d course(1, 0);
  for (int i = 0; i < 1000; ++i) FollowCourse({0, 0.01}, course);
  EXPECT_NEAR(course.x(), std::exp(-1), 0.001);  // Ten metres to the left: a tenfold share of 1/e.
  EXPECT_NEAR(course.y(), 1 - std::exp(-1), 0.001);
  FollowCourse({0, 0}, course);
  EXPECT_TRUE(course.allFinite());
}

}  // namespace
}  // namespace footing::terrain
