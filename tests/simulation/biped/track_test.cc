#include <cmath>
#include <numbers>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "common/base/units.h"
#include "daemon/simulation/biped/ground.h"
#include "daemon/simulation/biped/track.h"
#include "tests/simulation/test_world.h"

namespace footing::terrain {
namespace {

stream::Track Build() { return ParseTrack(test::DataFile("tracks/build.json"), "build").value(); }

std::string Why(const stream::Track& track, const NewSegment& segment, int here = 0) {
  const char* why = WhyNotAppended(track, segment, here);
  return why != nullptr ? why : "";
}

TEST(Append, ContinuesTheTrackAtItsEnd) {
  stream::Track track = Build();
  const double slope_rad = DegreesToRadians(4), curve_rad = DegreesToRadians(-10);
  Append({.length_m = 3, .slope_rad = slope_rad, .curve_rad = curve_rad, .step_m = 0.08}, track);
  Append({.length_m = 2}, track);
  ASSERT_EQ(track.segments.size(), 6u);
  EXPECT_EQ(track.revision, 3u);
  const stream::TrackSegment& slope = track.segments[4];
  EXPECT_NEAR(slope.start_m.x(), 16, 1e-12);
  EXPECT_NEAR(slope.start_m.z(), 0.08, 1e-12);
  EXPECT_NEAR(slope.heading_rad, curve_rad, 1e-12);
  EXPECT_NEAR(track.segments[5].start_m.z(), 0.08 + 3 * std::sin(slope_rad), 1e-12);
  EXPECT_NEAR(track.segments[5].heading_rad, curve_rad, 1e-12);
  EXPECT_EQ(track.segments[5].width_m, 4);
}

TEST(Append, RefusesWhatIsOutsideTheLimitsAndSaysWhich) {
  const stream::Track track = Build();
  const double past = 1e-3;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const struct {
    NewSegment segment;
    const char* word;
  } rows[] = {{{.length_m = 2 - past}, "length"},
              {{.length_m = 4 + past}, "length"},
              {{.length_m = nan}, "length"},
              {{.slope_rad = DegreesToRadians(5) + past}, "slope"},
              {{.slope_rad = nan}, "slope"},
              {{.curve_rad = -DegreesToRadians(15) - past}, "curve"},
              {{.step_m = 0.10 + past}, "step"},
              {{.step_m = -nan}, "step"},
              {{.length_m = 1.6, .pit = true}, "pit"},
              {{.length_m = 0.8, .step_m = 0.05, .pit = true}, "pit"}};
  for (const auto& row : rows) {
    EXPECT_NE(Why(track, row.segment).find(row.word), std::string::npos) << row.word;
  }
  EXPECT_EQ(Why(track, {.length_m = 4, .slope_rad = DegreesToRadians(-5)}), "");
  EXPECT_EQ(Why(track, {.length_m = 2, .curve_rad = DegreesToRadians(15), .step_m = 0.10}), "");
  EXPECT_EQ(Why(track, {.length_m = 0.8, .pit = true}), "");
}

TEST(Append, RefusesTwoStepsCloserThanAMetre) {
  stream::Track track = Build();
  Append({.length_m = 2, .step_m = 0.1}, track);
  EXPECT_EQ(Why(track, {.step_m = 0.1}), "");  // 2 m apart.
  // A pit of 0.6 m whose near edge is a step's: the step after it would be 0.6 m from that one.
  track.segments.back().length_m = 0.6;
  EXPECT_NE(Why(track, {.step_m = -0.05}).find("1 m apart"), std::string::npos);
  EXPECT_EQ(Why(track, {.step_m = 0}), "");
}

TEST(Append, RefusesAPitAfterAPitAndACurveRightBehindOne) {
  stream::Track track = Build();
  Append({.length_m = 0.8, .pit = true}, track);
  EXPECT_NE(Why(track, {.length_m = 0.8, .pit = true}).find("pit"), std::string::npos);
  EXPECT_NE(Why(track, {.curve_rad = 0.1}).find("curve"), std::string::npos);
  EXPECT_EQ(Why(track, {}), "");
}

TEST(Append, RefusesATrackThatRunsIntoItself) {
  stream::Track track = Build();
  const NewSegment bend{.length_m = 2.5, .curve_rad = DegreesToRadians(15)};
  int bends = 0;
  while (Why(track, bend).empty() && bends < 40) {
    Append(bend, track);
    ++bends;
  }
  EXPECT_NE(Why(track, bend).find("into itself"), std::string::npos);
  // A full circle is 24 bends of 15 degrees; the ribbon's width comes before.
  EXPECT_GT(bends, 15);
  EXPECT_LT(bends, 24);
}

TEST(Append, DropsTheOldestOnlyOnceTheCharacterIsFarEnough) {
  stream::Track track = Build();
  while (track.segments.size() < kMostSegments) Append({}, track);
  EXPECT_NE(Why(track, {}, kKeptBehind - 1).find("full"), std::string::npos);
  EXPECT_EQ(Why(track, {}, kKeptBehind), "");
  const double second_m = track.segments[1].start_m.x();
  Append({}, track);
  EXPECT_EQ(track.segments.size(), kMostSegments);
  EXPECT_EQ(track.segments[0].start_m.x(), second_m);
}

TEST(Append, NeedsATrackThatIsMadeForIt) {
  const auto track = ParseTrack(test::DataFile("tracks/plain.json"), "plain").value();
  EXPECT_NE(Why(track, {}).find("build"), std::string::npos);
}

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

/// Why a track of these segments, with these further keys, is refused; empty when it is not.
std::string Refusal(const std::string& segments, const std::string& keys = "") {
  const auto track =
      ParseTrack(R"({"version": 1, )" + keys + R"("segments": [)" + segments + "]}", "lab.json");
  return track ? "" : track.error().message;
}

TEST(TrackFile, HasGroundUnderTheCharacterBeforeTheFirstPit) {
  EXPECT_EQ(Refusal(R"({"length_m": 2, "pit": true}, {"length_m": 20})"),
            "lab.json, segment 0: the pit begins 0.00 m from the start of the track, where the "
            "character stands; put at least 1 m of ground before it");
  const std::string near =
      Refusal(R"({"length_m": 0.3, "repeat": 3}, {"length_m": 1, "pit": true}, {"length_m": 20})");
  EXPECT_NE(near.find("segment 1: the pit begins 0.90 m"), std::string::npos) << near;
  EXPECT_EQ(Refusal(R"({"length_m": 1}, {"length_m": 1, "pit": true}, {"length_m": 20})"), "");
  // A later pit may follow shorter ground.
  EXPECT_EQ(Refusal(R"({"length_m": 6}, {"length_m": 1, "pit": true}, {"length_m": 0.5},
                       {"length_m": 1, "pit": true}, {"length_m": 20})"),
            "");
}

TEST(TrackFile, HasItsStartLineOnGroundThatGoesOn) {
  const char* pit = R"({"length_m": 4}, {"length_m": 2, "pit": true}, {"length_m": 20})";
  EXPECT_EQ(Refusal(pit, R"("start_m": 5, )"),
            "lab.json: start_m is 5, in a pit; put the start line on the ground");
  EXPECT_EQ(Refusal(pit, R"("start_m": 3, )"), "");
  EXPECT_EQ(Refusal(R"({"length_m": 1.5})", R"("finish_m": 0, )"),
            "lab.json: the track is 1.50 m long, its start line is at 1 m; at least 1 m of track "
            "must follow it");
  EXPECT_EQ(Refusal(R"({"length_m": 2})", R"("finish_m": 0, )"), "");
}

TEST(TrackFile, IsLongEnoughForItsFinishLine) {
  EXPECT_EQ(
      Refusal(R"({"length_m": 6})"),
      "lab.json: the track is 6.00 m long, too short for a finish line 5 m before its end; make "
      "it longer than 6 m, or set finish_m");
  EXPECT_NE(Refusal(R"({"length_m": 0.5})"), "");
  for (const char* keys : {R"("finish_m": 0, )", R"("finish_m": 4, )", R"("open": true, )",
                           R"("extendable": true, )", R"("endless": true, )"}) {
    EXPECT_EQ(Refusal(R"({"length_m": 6})", keys), "") << keys;
  }
  EXPECT_EQ(Refusal(R"({"length_m": 6.1})"), "");
}

TEST(TrackFile, BendsBesideItsPits) {
  EXPECT_EQ(Refusal(R"({"length_m": 10}, {"length_m": 1, "pit": true, "curve_deg": 30},
                       {"length_m": 20})"),
            "lab.json, segment 1: a pit has no curve_deg; put the curve before or after it");
  EXPECT_EQ(Refusal(R"({"length_m": 10}, {"length_m": 1, "pit": true},
                       {"length_m": 20, "curve_deg": 30})"),
            "");
}

TEST(TrackFile, RefusesNumbersOutOfRangeByName) {
  for (const char* text :
       {R"({"version": 1, "segments": [{"length_m": -3}]})", R"({"version": 1, "segments": []})",
        R"({"version": 2, "segments": [{"length_m": 3}]})",
        R"({"version": 1, "segments": [{"length_m": 3, "slope_deg": 80}]})", "[1, 2]",
        R"({"version": 1, "segments": [{"length_m": 3, "repeat": 1001}]})",
        R"({"version": 1, "segments": [{"length_m": 3, "lenght_m": 3}]})",
        R"({"version": 1, "help_over_pit": false, "segments": [{"length_m": 3}]})",
        R"({"version": 1, "start_m": 20, "finish_m": 10, "segments": [{"length_m": 30}]})",
        R"({"version": 1, "mark": {"at_m": 9}, "segments": [{"length_m": 30}]})",
        R"({"version": 1, "mark": {"at_m": 29, "tasks": [{"name": "a", "after": "run"}]},
            "segments": [{"length_m": 30}]})",
        R"({"version": 1, "mark": {"at_m": 9, "tasks": [{"name": "a", "after": "fly"}]},
            "segments": [{"length_m": 30}]})",
        R"({"version": 1, "mark": {"at_m": 9, "tasks": [{"name": "a", "before": "run",
            "after": "run"}]}, "segments": [{"length_m": 30}]})",
        R"({"version": 1, "endless": true, "segments": [{"length_m": 5, "slope_deg": 1}]})",
        R"({"version": 1, "endless": true, "extendable": true, "segments": [{"length_m": 5}]})",
        R"({"version": 1, "extendable": true, "help_over_pits": false,
            "segments": [{"length_m": 5}]})"}) {
    const auto track = ParseTrack(text, "bad.json");
    ASSERT_FALSE(track.ok()) << text;
    EXPECT_NE(track.error().message.find("bad.json"), std::string::npos);
  }
}

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
