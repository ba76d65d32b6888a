#include "daemon/simulation/biped/append.h"

#include <string>

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

}  // namespace
}  // namespace footing::terrain
