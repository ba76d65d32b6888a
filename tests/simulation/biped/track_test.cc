#include "daemon/simulation/biped/track.h"

#include <cmath>
#include <numbers>
#include <set>

#include "daemon/simulation/biped/box.h"
#include "daemon/simulation/biped/ground.h"
#include "tests/simulation/test_world.h"

namespace footing::terrain {
namespace {

constexpr const char* kHills = R"({"version": 1, "name": "hills", "segments": [
  {"length_m": 10}, {"length_m": 10, "slope_deg": 5}, {"length_m": 2, "pit": true},
  {"length_m": 5, "curve_deg": 90, "step_m": 0.1}]})";

stream::Track Carried(const std::string& name) {
  return ParseTrack(test::DataFile("tracks/" + name + ".json"), name).value();
}

TEST(Track, PlainOneIsFourMetresWideAndLevel) {
  const auto track = ParseTrack(test::DataFile("tracks/plain.json"), "plain");
  ASSERT_TRUE(track.ok());
  EXPECT_EQ(track.value().segments.front().width_m, 4.0);  // Paper, section 8.2.
  EXPECT_TRUE(IsLevel(track.value()));
  EXPECT_EQ(GroundHeight(track.value(), 123, -1), 0);
}

TEST(Track, SegmentsContinueEachOther) {
  const auto track = ParseTrack(kHills, "hills");
  ASSERT_TRUE(track.ok());
  const auto& segments = track.value().segments;
  const double up = 10 * std::sin(5 * std::numbers::pi / 180);
  const double on = 10 + 10 * std::cos(5 * std::numbers::pi / 180);
  EXPECT_NEAR(segments[2].start_m.z(), up, 1e-12);
  EXPECT_NEAR(segments[3].start_m.z(), up + 0.1, 1e-12);
  EXPECT_NEAR(segments[3].start_m.x(), on + 2, 1e-12);
  EXPECT_NEAR(segments[3].heading_rad, std::numbers::pi / 2, 1e-12);
  EXPECT_FALSE(IsLevel(track.value()));
}

TEST(Track, GroundRisesWithTheSlopeAndIsDeepInAPit) {
  const auto track = ParseTrack(kHills, "hills").value();
  EXPECT_NEAR(GroundHeight(track, 15, 0), 5 * std::tan(5 * std::numbers::pi / 180), 1e-12);
  const double pit_x = track.segments[2].start_m.x() + 1;
  EXPECT_NEAR(GroundHeight(track, pit_x, 0), track.segments[2].start_m.z() - kPitDepthM, 1e-12);
  EXPECT_NEAR(RibbonHeight(track, pit_x, 0), track.segments[2].start_m.z(), 1e-12);
}

TEST(Track, PutsBackOnTheCentreLineAndNeverIntoAPit) {
  const auto track = ParseTrack(kHills, "hills").value();
  const CentrePoint back = CentreBehind(track, Locate(track, {8, 1.5}), 3);
  EXPECT_NEAR(back.p_W_m.x(), 5, 1e-12);
  EXPECT_NEAR(back.p_W_m.y(), 0, 1e-12);
  EXPECT_NEAR(CentreBehind(track, Locate(track, {1, 0}), 3).p_W_m.x(), 0, 1e-12);
  // 1 m into the last segment, 3 m back would be in the pit: its near edge instead, or before.
  const auto& last = track.segments[3];
  const CentrePoint before_pit = CentreBehind(track, {3, 2.5, 0}, 3);
  EXPECT_LE(before_pit.p_W_m.x(), track.segments[2].start_m.x() - 0.49);
  // On the far side there is room behind the edge too.
  const CentrePoint behind_pit = CentreBehind(track, {3, 0.2, 0}, 0);
  EXPECT_GE(behind_pit.p_W_m.y(), last.start_m.y() + 0.49);
  EXPECT_LT(before_pit.p_W_m.x(), last.start_m.x());
}

/// The nearest of points 1 mm apart on every segment's centre line.
double DistanceBySearch(const stream::Track& track, const Eigen::Vector2d& p_W_m) {
  double distance_m = INFINITY;
  for (std::size_t i = 0; i < track.segments.size(); ++i) {
    const stream::TrackSegment& segment = track.segments[i];
    const double level_m = segment.length_m * std::cos(segment.slope_rad);
    const Eigen::Vector2d ahead(std::cos(segment.heading_rad), std::sin(segment.heading_rad));
    for (double along_m = 0; along_m <= level_m; along_m += 1e-3) {
      const Eigen::Vector2d on_m = segment.start_m.head<2>() + along_m * ahead;
      distance_m = std::min(distance_m, (p_W_m - on_m).norm());
    }
  }
  return distance_m;
}

TEST(Track, FindsTheNearestPlaceFromAnywhere) {
  for (const char* name : {"3", "hills", "corners"}) {
    const stream::Track track = Carried(name);
    for (int x_m = -20; x_m <= 100; x_m += 17) {
      for (int y_m = -60; y_m <= 60; y_m += 13) {
        const Eigen::Vector2d p_m(x_m, y_m);
        EXPECT_NEAR(Locate(track, p_m).distance_m, DistanceBySearch(track, p_m), 1e-3)
            << name << " " << p_m.transpose();
      }
    }
  }
}

TEST(Track, PlacesAheadAndLengthsFollowTheCentreLine) {
  const auto track = ParseTrack(kHills, "hills").value();
  EXPECT_NEAR(LengthOf(track), 27, 1e-12);
  const TrackPlace place = Locate(track, {4, 1});
  EXPECT_NEAR(LengthTo(track, place), 4, 1e-12);
  EXPECT_NEAR(place.distance_m, 1, 1e-12);
  // 19 m further: 23 m from the start, 1 m into the last segment, which runs along y.
  const CentrePoint ahead = CentreAhead(track, place, 19);
  EXPECT_NEAR(ahead.p_W_m.y(), 1, 1e-12);
  EXPECT_NEAR(ahead.heading_rad, std::numbers::pi / 2, 1e-12);
  EXPECT_NEAR(CentreAhead(track, place, 1000).p_W_m.y(), 5, 1e-12);
}

TEST(Track, APlaceIsFoundByItsLengthAndTheOtherWayRound) {
  auto track = ParseTrack(kHills, "hills").value();
  for (const double length_m : {0.0, 4.0, 15.5, 21.0, 26.9}) {
    EXPECT_NEAR(LengthTo(track, PlaceAt(track, length_m)), length_m, 1e-12);
  }
  EXPECT_NEAR(LengthTo(track, PlaceAt(track, -3)), 0, 1e-12);
  EXPECT_NEAR(LengthTo(track, PlaceAt(track, 99)), 27, 1e-12);
  track.first_m = 100;  // As much was dropped.
  EXPECT_EQ(PlaceAt(track, 115.5).segment, 1);
  EXPECT_NEAR(LengthTo(track, PlaceAt(track, 115.5)), 115.5, 1e-12);
  EXPECT_NEAR(LengthTo(track, PlaceAt(track, 50)), 100, 1e-12);
}

TEST(Track, IsLeftAtItsSidesAndBeyondItsEnds) {
  const auto track = ParseTrack(kHills, "hills").value();
  EXPECT_FALSE(IsOffRibbon(track, Locate(track, {5, 1.9})));
  EXPECT_TRUE(IsOffRibbon(track, Locate(track, {5, -2.1})));
  EXPECT_TRUE(IsOffRibbon(track, Locate(track, {-2.1, 0})));
}

class CarriedTrack : public testing::TestWithParam<const char*> {};

TEST_P(CarriedTrack, IsARibbonOfFourMetresAndEightyToAHundredAndTwenty) {
  const std::string name = std::string("tracks/") + GetParam() + ".json";
  const auto track = ParseTrack(test::DataFile(name), name);
  ASSERT_TRUE(track.ok()) << track.error().message;
  EXPECT_FALSE(track.value().open);
  EXPECT_GE(LengthOf(track.value()), 80);
  EXPECT_LE(LengthOf(track.value()), 120);
  for (const auto& segment : track.value().segments) EXPECT_EQ(segment.width_m, 4);
}

TEST_P(CarriedTrack, NeverComesNearItselfAgain) {
  const auto track = Carried(GetParam());
  for (double s_m = 0; s_m < LengthOf(track); s_m += 0.5) {
    const CentrePoint here = CentreAhead(track, {}, s_m);
    // The nearest place is where one is: no other pass of the track is nearer.
    EXPECT_NEAR(LengthTo(track, Locate(track, here.p_W_m.head<2>())), s_m, 1e-6);
    for (double ahead_m = 12; s_m + ahead_m < LengthOf(track); ahead_m += 0.5) {
      const CentrePoint there = CentreAhead(track, {}, s_m + ahead_m);
      EXPECT_GT((there.p_W_m - here.p_W_m).head<2>().norm(), 5) << s_m << " m and " << ahead_m;
    }
  }
}

TEST_P(CarriedTrack, HasItsFinishLineFiveMetresBeforeTheEndAndHalfAMetreFromPits) {
  const auto track = Carried(GetParam());
  EXPECT_EQ(track.start_m, 1);
  EXPECT_NEAR(track.finish_m, LengthOf(track) - 5, 1e-9);
  for (const double line_m : {track.start_m, track.finish_m}) {
    for (const double beside_m : {-0.5, 0.5}) {
      const CentrePoint point = CentreAhead(track, {}, line_m + beside_m);
      const TrackPlace place = Locate(track, point.p_W_m.head<2>());
      EXPECT_FALSE(track.segments[static_cast<std::size_t>(place.segment)].pit) << line_m;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, CarriedTrack,
                         testing::Values("1", "2", "3", "4", "curves", "corners", "pits", "hills"));

class TestTrack : public testing::TestWithParam<const char*> {};

TEST_P(TestTrack, HasCurvesToBothSidesAndThreePitsThatTheUserMustTime) {
  const auto track = Carried(GetParam());
  EXPECT_FALSE(track.help_over_pits);
  double left_rad = 0, right_rad = 0;
  std::multiset<double> pits_m;
  for (std::size_t i = 1; i < track.segments.size(); ++i) {
    const auto& segment = track.segments[i];
    EXPECT_EQ(segment.slope_rad, 0);
    EXPECT_EQ(segment.start_m.z(), 0);
    const double turn_rad = segment.heading_rad - track.segments[i - 1].heading_rad;
    (turn_rad > 0 ? left_rad : right_rad) += std::fabs(turn_rad);
    if (segment.pit) pits_m.insert(segment.length_m);
  }
  EXPECT_GT(left_rad, 0.7);
  EXPECT_GT(right_rad, 0.7);
  EXPECT_NEAR(left_rad + right_rad, 1.5 * std::numbers::pi, 1e-9);  // The same on all four.
  EXPECT_EQ(pits_m, (std::multiset<double>{0.3, 0.4, 0.5}));
}

INSTANTIATE_TEST_SUITE_P(OneToFour, TestTrack, testing::Values("1", "2", "3", "4"));

TEST(StraightTrack, AsksForEveryChangeOfGaitOfThePaperAtItsLine) {
  const auto track = Carried("straight");
  EXPECT_FALSE(track.open);
  EXPECT_EQ(track.mark_m, 30);
  EXPECT_EQ(track.finish_m, 60);
  EXPECT_EQ(track.segments.size(), 1u);
  std::set<std::pair<stream::Gait, stream::Gait>> changes;
  for (const auto& task : track.tasks) changes.insert({task.before, task.after});
  using stream::Gait;  // Section 8.1: to jump, to stop, and to change between walking and running.
  const std::set<std::pair<Gait, Gait>> expected{
      {Gait::kWalk, Gait::kJump}, {Gait::kRun, Gait::kJump}, {Gait::kWalk, Gait::kStep},
      {Gait::kRun, Gait::kStep},  {Gait::kWalk, Gait::kRun}, {Gait::kRun, Gait::kWalk}};
  EXPECT_EQ(changes, expected);
  EXPECT_EQ(track.tasks[0].instruction, "walk to the line, then run");
}

TEST(Track, ASegmentRepeats) {
  const auto track = ParseTrack(
      R"({"version": 1, "finish_m": 0,
          "segments": [{"length_m": 2, "curve_deg": 30, "repeat": 3}]})",
      "arc");
  ASSERT_TRUE(track.ok());
  ASSERT_EQ(track.value().segments.size(), 3u);
  EXPECT_NEAR(track.value().segments[2].heading_rad, std::numbers::pi / 2, 1e-12);
  EXPECT_NEAR(LengthOf(track.value()), 6, 1e-12);
}

TEST(Track, OneThatMayBeLeftOrGrowsHasNoFinishLine) {
  for (const char* text : {R"({"version": 1, "open": true, "segments": [{"length_m": 50}]})",
                           R"({"version": 1, "extendable": true, "segments": [{"length_m": 50}]})",
                           R"({"version": 1, "endless": true, "segments": [{"length_m": 50}]})"}) {
    EXPECT_EQ(ParseTrack(text, "track").value().finish_m, 0) << text;
  }
  EXPECT_EQ(ParseTrack(R"({"version": 1, "segments": [{"length_m": 50}]})", "").value().finish_m,
            45);
}

TEST(Track, OnlyGroundThatMayBeLeftIsAnEndlessPlane) {
  const auto geoms = [](const char* text) { return GroundMjcf(ParseTrack(text, "").value()).mjcf; };
  EXPECT_NE(geoms(R"({"version": 1, "open": true, "segments": [{"length_m": 50}]})").find("plane"),
            std::string::npos);
  EXPECT_EQ(geoms(R"({"version": 1, "segments": [{"length_m": 50}]})").find("plane"),
            std::string::npos);
}

TEST(GroundWindow, HasTheBoxesWithinReachOfAnyPoint) {
  const auto window = [](const char* text) { return WindowOf(ParseTrack(text, "").value()); };
  const auto boxes = [](const char* text) {
    const std::string geoms = GroundMjcf(ParseTrack(text, "").value()).mjcf;
    int count = 0;
    for (auto at = geoms.find("'box'"); at != std::string::npos; at = geoms.find("'box'", at + 1))
      ++count;
    return count;
  };
  // One segment on either side of 3 m; two of 1.5 m.
  const char* long_ones =
      R"({"version": 1, "segments": [{"length_m": 3, "step_m": 0.1, "repeat": 20}]})";
  EXPECT_EQ(window(long_ones).boxes, 3);
  EXPECT_EQ(window(long_ones).behind, 1);
  EXPECT_EQ(boxes(long_ones), 3);
  const char* short_ones = R"({"version": 1, "segments": [{"length_m": 1.5, "repeat": 20}]})";
  EXPECT_EQ(window(short_ones).boxes, 5);
  EXPECT_EQ(window(short_ones).behind, 2);
  // As many as the track has, or more than there may be: all of them stay.
  EXPECT_EQ(window(R"({"version": 1, "segments": [{"length_m": 3, "repeat": 3}]})").boxes, 0);
  const char* tiny_ones = R"({"version": 1, "segments": [{"length_m": 0.1, "repeat": 200}]})";
  EXPECT_EQ(window(tiny_ones).boxes, 0);
  EXPECT_EQ(boxes(tiny_ones), 200);
  EXPECT_EQ(window(R"({"version": 1, "extendable": true, "segments": [{"length_m": 50}]})").boxes,
            kGroundBoxes);
}

TEST(GroundBox, KeepsAPitsEdges) {
  const auto track = ParseTrack(kHills, "hills").value();
  const GroundBox after_pit = BoxOf(track, 3);
  EXPECT_NEAR(after_pit.half_size_m.x(), 2.5, 1e-12);
}

}  // namespace
}  // namespace footing::terrain
