#include "daemon/simulation/terrain/track.h"

#include <cmath>
#include <numbers>

#include "daemon/simulation/terrain/ground.h"
#include "tests/simulation/test_world.h"

namespace footing::terrain {
namespace {

constexpr const char* kHills = R"({"version": 1, "name": "hills", "segments": [
  {"length_m": 10}, {"length_m": 10, "slope_deg": 5}, {"length_m": 2, "pit": true},
  {"length_m": 5, "curve_deg": 90, "step_m": 0.1}]})";

TEST(Track, StraightOneIsFourMetresWideAndLevel) {
  const auto track = ParseTrack(test::DataFile("tracks/straight.json"), "straight");
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
  EXPECT_LE(before_pit.p_W_m.x(), track.segments[2].start_m.x() + 1e-9);
  EXPECT_LT(before_pit.p_W_m.x(), last.start_m.x());
}

TEST(Track, RefusesNumbersOutOfRangeByName) {
  for (const char* text :
       {R"({"version": 1, "segments": [{"length_m": -3}]})", R"({"version": 1, "segments": []})",
        R"({"version": 2, "segments": [{"length_m": 3}]})",
        R"({"version": 1, "segments": [{"length_m": 3, "slope_deg": 80}]})", "[1, 2]"}) {
    const auto track = ParseTrack(text, "bad.json");
    ASSERT_FALSE(track.ok()) << text;
    EXPECT_NE(track.error().message.find("bad.json"), std::string::npos);
  }
}

}  // namespace
}  // namespace footing::terrain
