#include "clients/game/rules/director.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "common/base/units.h"
#include "daemon/simulation/biped/track.h"
#include "tests/clients/game/short_track.h"

namespace footing::game {
namespace {

Hand Inclined(double roll_deg, double pitch_deg, bool a = false, bool b = false) {
  return {true, DegreesToRadians(roll_deg), DegreesToRadians(pitch_deg), a, b};
}

/// Segment that footing-sim is asked for.
terrain::NewSegment ToSegment(const Piece& piece) {
  return {piece.length_m, piece.slope_rad, piece.curve_rad, piece.step_m, piece.pit};
}

TEST(Piece, IsASlopeVerticallyACurveSidewaysAndAStepWithA) {
  const stream::Track track = ShortTrack();
  const Piece up = Held(Inclined(0, 90), track, 0, false);
  EXPECT_DOUBLE_EQ(up.slope_rad, DegreesToRadians(5));
  EXPECT_EQ(up.curve_rad, 0);
  EXPECT_EQ(up.step_m, 0);
  // Inclined to the right, left side higher: a curve to the right, which is negative.
  const Piece right = Held(Inclined(90, 0), track, 0, false);
  EXPECT_DOUBLE_EQ(right.curve_rad, -DegreesToRadians(15));
  EXPECT_EQ(right.slope_rad, 0);
  const Piece down = Held(Inclined(0, -90, true), track, 0, false);
  EXPECT_DOUBLE_EQ(down.step_m, -0.10);
  EXPECT_EQ(down.slope_rad, 0);
}

TEST(Piece, IsLevelWithinTheDeadZoneAndGrowsEvenlyBeyondIt) {
  const stream::Track track = ShortTrack();
  EXPECT_EQ(Held({true, kDeadZoneRad, -kDeadZoneRad}, track, 0, false), Piece());
  EXPECT_EQ(Held({true, -kDeadZoneRad, kDeadZoneRad, true}, track, 0, false), Piece());
  const double half_rad = (kDeadZoneRad + kFullRad) / 2;
  const Piece half = Held({true, half_rad, half_rad}, track, 0, false);
  EXPECT_NEAR(half.slope_rad, DegreesToRadians(2.5), 1e-12);
  EXPECT_NEAR(half.curve_rad, -DegreesToRadians(7.5), 1e-12);
  EXPECT_NEAR(Held({true, 0, half_rad, true}, track, 0, false).step_m, 0.05, 1e-12);
  EXPECT_EQ(Held({true, 0, kFullRad}, track, 0, false), Held({true, 0, 1.5}, track, 0, false));
}

TEST(Piece, IsLevelForAHandThatIsNotKnown) {
  Hand hand = Inclined(40, 40, true, true);
  hand.known = false;
  EXPECT_EQ(Held(hand, ShortTrack(), 0, true), Piece());
}

TEST(Piece, LastsAboutASecondOfRunning) {
  const stream::Track track = ShortTrack();
  EXPECT_EQ(Held({}, track, 0.5, false).length_m, 2);
  EXPECT_EQ(Held({}, track, 2.7, false).length_m, 2.7);
  EXPECT_EQ(Held({}, track, 6, false).length_m, 4);
}

TEST(Piece, IsAPitForBWherePitsAreAllowed) {
  stream::Track track = ShortTrack();
  EXPECT_FALSE(Held(Inclined(0, 0, false, true), track, 2, false).pit);
  const Piece least = Held(Inclined(30, -30, true, true), track, 2, true);
  EXPECT_TRUE(least.pit);
  EXPECT_DOUBLE_EQ(least.length_m, 0.3);
  EXPECT_EQ(least.slope_rad + least.curve_rad + least.step_m, 0);
  EXPECT_DOUBLE_EQ(Held(Inclined(0, 60, false, true), track, 2, true).length_m, 1.5);
  Lay(least, track);
  // After a pit: ground, and straight on.
  const Piece after = Held(Inclined(60, 60, false, true), track, 2, true);
  EXPECT_FALSE(after.pit);
  EXPECT_EQ(after.curve_rad, 0);
  EXPECT_GT(after.slope_rad, 0);
}

TEST(Piece, LeavesTheTrackWithinNinetyDegreesOfItsStart) {
  stream::Track track = ShortTrack();
  for (int i = 0; i < 20; ++i) Lay(Held(Inclined(-90, 0), track, 2, false), track);
  EXPECT_NEAR(track.segments.back().heading_rad, kPi / 2, 1e-12);
  // Back from there it turns at once.
  EXPECT_NEAR(Held(Inclined(90, 0), track, 2, false).curve_rad, -DegreesToRadians(15), 1e-12);
}

// Hands that do anything, for 40 tracks of 200 pieces: footing-sim would take each of them.
TEST(Piece, IsOneThatTheTrackTakesWhateverTheHandDoes) {
  for (unsigned seed = 1; seed <= 40; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> inclination(-1.6, 1.6), speed(0, 5), chance(0, 1);
    stream::Track track = ShortTrack();
    // Some hold one side for long, which is what leads a track into itself.
    const double side = seed % 3 == 0 ? 1.6 : 0;
    for (int i = 0; i < 200; ++i) {
      const double lasting = (i / 30) % 2 == 0 ? side : -side;
      const Hand hand{chance(random) < 0.95, lasting != 0 ? lasting : inclination(random),
                      inclination(random), chance(random) < 0.3, chance(random) < 0.2};
      const Piece piece = Held(hand, track, speed(random), seed % 2 == 0);
      const terrain::NewSegment segment = ToSegment(piece);
      const int here = static_cast<int>(track.segments.size()) - 5;
      ASSERT_EQ(terrain::WhyNotAppended(track, segment, here), nullptr)
          << "seed " << seed << " piece " << i;
      const stream::TrackSegment shown = track::Placed(piece, track.segments.back());
      terrain::Append(segment, track);
      // The ghost is what is laid, to the last bit.
      const stream::TrackSegment& laid = track.segments.back();
      ASSERT_EQ(shown.start_m, laid.start_m);
      ASSERT_EQ(shown.heading_rad, laid.heading_rad);
      ASSERT_EQ(shown.slope_rad, laid.slope_rad);
      ASSERT_EQ(shown.length_m, laid.length_m);
      ASSERT_EQ(shown.width_m, laid.width_m);
      ASSERT_EQ(shown.pit, laid.pit);
    }
  }
}

}  // namespace
}  // namespace footing::game
