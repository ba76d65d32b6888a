#include "clients/game/rules/director.h"

#include <gtest/gtest.h>

#include "tests/clients/game/short_track.h"

namespace footing::game {
namespace {

const Hand kUp{true, 0, 0.6};

TEST(Builder, KeepsGroundOfThreeSecondsAheadOfTheRunner) {
  EXPECT_EQ(LookAheadM(0), 6);
  EXPECT_EQ(LookAheadM(3), 9);
  EXPECT_EQ(LookAheadM(9), 12);
  const stream::Track track = ShortTrack(16);
  Builder builder(false);
  EXPECT_FALSE(builder.Advance({0, 7, 3, track}, kUp));     // 9 m ahead.
  EXPECT_TRUE(builder.Advance({0.1, 7.1, 3, track}, kUp));  // 8.9 m.
}

TEST(Builder, LaysWhatTheGhostShows) {
  stream::Track track = ShortTrack();
  Builder builder(false);
  EXPECT_FALSE(builder.Advance({0, 1, 2, track}, {true, 0.3, 0.3}));
  EXPECT_EQ(builder.ghost(), Held({true, 0.3, 0.3}, track, 2, false));
  // The hand has moved on: the ghost goes with it, and that is what is laid.
  const auto laid = builder.Advance({1, 14, 2, track}, kUp);
  ASSERT_TRUE(laid);
  EXPECT_EQ(*laid, builder.ghost());
  EXPECT_EQ(*laid, Held(kUp, track, 2, false));
}

TEST(Builder, WaitsForThePieceBeforeUpToASecond) {
  stream::Track track = ShortTrack();
  Builder builder(false);
  ASSERT_TRUE(builder.Advance({1, 14, 2, track}, kUp));
  EXPECT_FALSE(builder.Advance({1.5, 14.5, 2, track}, kUp));
  Lay(builder.ghost(), track);
  EXPECT_TRUE(builder.Advance({1.6, 14.6, 2, track}, kUp));
  // That one is lost.
  EXPECT_FALSE(builder.Advance({2.5, 14.7, 2, track}, kUp));
  EXPECT_TRUE(builder.Advance({2.7, 14.8, 2, track}, kUp));
}

TEST(Builder, LaysLevelGroundOnceAfterARefusal) {
  stream::Track track = ShortTrack();
  Builder builder(false);
  ASSERT_TRUE(builder.Advance({1, 14, 2, track}, kUp));
  builder.OnRefused();
  EXPECT_EQ(builder.refused(), 1u);
  const auto plain = builder.Advance({1.1, 14.1, 2, track}, kUp);
  ASSERT_TRUE(plain);
  EXPECT_EQ(*plain, Piece());
  Lay(*plain, track);
  const auto next = builder.Advance({1.2, 14.2, 2, track}, kUp);
  ASSERT_TRUE(next);
  EXPECT_GT(next->slope_rad, 0);
}

}  // namespace
}  // namespace footing::game
