#include "clients/game/rules/director.h"

#include <gtest/gtest.h>

#include "tests/clients/game/short_track.h"

namespace footing::game {
namespace {

using stream::FailureCause;

TEST(Facts, KnowWhatWasLaidAfterTheTrialBegan) {
  Collector seen;
  stream::Track track = ShortTrack(16);
  seen.OnTrack(track);
  seen.OnTrial(TrialAt("g-1", 2));
  Lay({3, 0.05, 0.2, 0.08, false}, track);
  Lay({1.2, 0, 0, 0, true}, track);
  seen.OnTrack(track);
  seen.OnTrial(TrialAt("g-1", 9, 4));
  seen.OnTrial(TrialAt("g-1", 6, 5));
  const RoundFacts* const facts = seen.Find("g-1");
  ASSERT_NE(facts, nullptr);
  EXPECT_EQ(facts->start_m, 1);
  EXPECT_EQ(facts->farthest_m, 9);  // It was put back since.
  EXPECT_EQ(facts->time_s, 5);
  ASSERT_EQ(facts->laid.size(), 2u);
  EXPECT_EQ(facts->laid[0].from_m, 16);
  EXPECT_EQ(facts->laid[0].length_m, 3);
  EXPECT_NEAR(facts->laid[0].slope_rad, 0.05, 1e-12);
  EXPECT_NEAR(facts->laid[0].curve_rad, 0.2, 1e-12);
  EXPECT_NEAR(facts->laid[0].step_m, 0.08, 1e-12);
  EXPECT_EQ(facts->laid[1].from_m, 19);
  EXPECT_TRUE(facts->laid[1].pit);
  EXPECT_NEAR(facts->laid[1].step_m, 0, 1e-12);
}

TEST(Facts, KeepWhatTheTrackHasDropped) {
  Collector seen;
  stream::Track track = ShortTrack(16);
  seen.OnTrack(track);
  seen.OnTrial(TrialAt("g-1", 2));
  for (int i = 0; i < 10; ++i) {
    Lay({2, 0.01 * i, 0, 0, false}, track);
    track.first_m += track.segments.front().length_m;
    track.segments.erase(track.segments.begin());
    seen.OnTrack(track);
    seen.OnTrial(TrialAt("g-1", 2));
  }
  const auto& laid = seen.Find("g-1")->laid;
  ASSERT_EQ(laid.size(), 10u);
  for (std::size_t i = 0; i < laid.size(); ++i) {
    EXPECT_NEAR(laid[i].from_m, 16 + 2.0 * static_cast<double>(i), 1e-9);
    EXPECT_NEAR(laid[i].slope_rad, 0.01 * static_cast<double>(i), 1e-12);
  }
}

TEST(Facts, CountFailuresOfTheirTrialAndTakeThoseWithdrawnAsSuch) {
  Collector seen;
  seen.OnTrack(ShortTrack());
  seen.OnFault({1, FailureCause::kCurve, "g-1", 5, false});  // Before it is known.
  seen.OnTrial(TrialAt("g-1", 2));
  seen.OnFault({2, FailureCause::kCurve, "g-1", 5, false});
  seen.OnFault({3, FailureCause::kCurve, "g-2", 5, false});
  seen.OnFault({2, FailureCause::kCurve, "g-1", 5, true});
  const auto& faults = seen.Find("g-1")->faults;
  ASSERT_EQ(faults.size(), 1u);
  EXPECT_TRUE(faults.at(2).withdrawn);
}

TEST(Facts, EndWithTheirTrialButForCorrections) {
  Collector seen;
  seen.OnTrack(ShortTrack());
  seen.OnTrial(TrialAt("g-1", 2));
  seen.OnFault({1, FailureCause::kCurve, "g-1", 2, false});
  stream::TrialState stopped = TrialAt("g-1", 3, 7);
  stopped.progress.phase = stream::TrialPhase::kStopped;
  seen.OnTrial(stopped);
  stopped.progress.distance_m = 9;
  seen.OnTrial(stopped);
  seen.OnFault({1, FailureCause::kCurve, "g-1", 2, true});
  seen.OnFault({2, FailureCause::kCurve, "g-1", 9, false});
  const RoundFacts& facts = *seen.Find("g-1");
  EXPECT_EQ(facts.farthest_m, 3);
  ASSERT_EQ(facts.faults.size(), 1u);
  EXPECT_TRUE(facts.faults.at(1).withdrawn);
}

TEST(Facts, BeginAgainWithAnotherTrialOfTheSameId) {
  Collector seen;
  seen.OnTrack(ShortTrack());
  seen.OnTrial(TrialAt("g-1", 12));
  stream::TrialState again = TrialAt("g-1", 2);
  again.number = 2;
  seen.OnTrial(again);
  EXPECT_EQ(seen.Find("g-1")->farthest_m, 2);
  EXPECT_EQ(seen.Find("g-2"), nullptr);
}

}  // namespace
}  // namespace footing::game
