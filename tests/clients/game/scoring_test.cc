#include "clients/game/rules/director.h"

#include <gtest/gtest.h>

#include "common/base/units.h"

namespace footing::game {
namespace {

using stream::FailureCause;

/// 16 m that nobody laid, then 4 segments of 2 m, the second with everything at its limit.
RoundFacts FourSegments(double farthest_m) {
  RoundFacts facts;
  facts.start_m = 1;
  facts.farthest_m = farthest_m;
  for (int i = 0; i < 4; ++i) facts.laid.push_back({16 + 2.0 * i, 2});
  facts.laid[1].slope_rad = DegreesToRadians(-5);
  facts.laid[1].curve_rad = DegreesToRadians(15);
  facts.laid[1].step_m = 0.10;
  facts.end_m = 24;
  return facts;
}

void Fail(RoundFacts& facts, FailureCause cause, double distance_m) {
  const std::uint64_t number = facts.faults.size() + 1;
  facts.faults[number] = {number, cause, "g", distance_m, false};
}

TEST(Scoring, CountsMetresAndDifficultGroundForTheRunner) {
  // 20 m from the start line, and past the segment whose three properties are at their limits.
  const stream::GameRound round = Score(FourSegments(21));
  EXPECT_DOUBLE_EQ(round.distance_m, 20);
  EXPECT_EQ(round.segments_laid, 4u);
  EXPECT_EQ(round.segments_passed, 2u);  // The third ends at 22 m.
  EXPECT_NEAR(round.difficulty, 3, 1e-12);
  EXPECT_NEAR(round.runner_points, 20 * kPointsPerM + 3 * kPointsPerDifficulty, 1e-12);
  EXPECT_EQ(round.builder_points, 0);
}

TEST(Scoring, GivesNothingForASegmentWithAFailureOnIt) {
  RoundFacts facts = FourSegments(21);
  Fail(facts, FailureCause::kSimulation, 19);
  const stream::GameRound round = Score(facts);
  EXPECT_EQ(round.segments_passed, 1u);
  EXPECT_EQ(round.difficulty, 0);
  EXPECT_DOUBLE_EQ(round.runner_points, 20 * kPointsPerM + kPointsPerFailure);
  EXPECT_EQ(round.failures.simulation, 1u);
}

TEST(Scoring, CountsFailuresOnLaidGroundByKindForTheBuilder) {
  const std::pair<FailureCause, double> kinds[] = {{FailureCause::kSimulation, kPointsPerFall},
                                                   {FailureCause::kCurve, kPointsPerExit},
                                                   {FailureCause::kJump, kPointsPerPit}};
  for (const auto& [cause, points] : kinds) {
    RoundFacts facts = FourSegments(21);
    Fail(facts, cause, 17);
    EXPECT_EQ(Score(facts).builder_points, points) << stream::Name(cause);
    Fail(facts, cause, 21);  // On another segment: in full again.
    EXPECT_EQ(Score(facts).builder_points, 2 * points) << stream::Name(cause);
  }
  RoundFacts on_start = FourSegments(21);
  Fail(on_start, FailureCause::kCurve, 10);
  EXPECT_EQ(Score(on_start).builder_points, 0);
  EXPECT_EQ(Score(on_start).runner_points, Score(FourSegments(21)).runner_points - 5);
}

TEST(Scoring, GivesLessForAStretchThatCannotBePassed) {
  RoundFacts facts = FourSegments(19);
  for (int i = 0; i < 5; ++i) Fail(facts, FailureCause::kCurve, 18.5);
  const stream::GameRound round = Score(facts);
  EXPECT_EQ(round.failures.curve, 5u);
  EXPECT_DOUBLE_EQ(round.builder_points, kPointsPerExit * (1 + kSecondShare));
  EXPECT_DOUBLE_EQ(round.runner_points, 18 * kPointsPerM + 2 * kPointsPerFailure);
}

TEST(Scoring, LeavesWithdrawnFailuresOutAndNobodyBelowZero) {
  RoundFacts facts = FourSegments(2);
  for (const double at_m : {3.0, 3.0, 17.0}) Fail(facts, FailureCause::kCurve, at_m);
  EXPECT_EQ(Score(facts).runner_points, 0);
  for (auto& [number, fault] : facts.faults) fault.withdrawn = true;
  EXPECT_EQ(Score(facts).runner_points, 1);
  EXPECT_EQ(Score(facts).builder_points, 0);
  EXPECT_EQ(stream::Total(Score(facts).failures), 0u);
}

TEST(Scoring, HoldsPitsForHarderTheLongerTheyAre) {
  EXPECT_DOUBLE_EQ(DifficultyOf({0, 1.5, 0, 0, 0, true}), 2);
  EXPECT_DOUBLE_EQ(DifficultyOf({0, 0.3, 0, 0, 0, true}), 1.2);
  EXPECT_EQ(DifficultyOf({0, 3}), 0);
}

TEST(Scoring, AddsUpEachPlayersPartsAndNamesTheWinnerAtTheEnd) {
  stream::GameState game;
  game.phase = stream::GamePhase::kRound;
  game.players = {{"Ann", 99}, {"Ben", 99}};
  game.rounds = 2;
  game.results.resize(2);
  game.results[0].runner_points = 30;
  game.results[0].builder_points = 8;
  game.results[1].runner = 1;
  game.results[1].runner_points = 20;
  game.results[1].builder_points = 5;
  AddUp(game);
  EXPECT_EQ(game.players[0].points, 35);
  EXPECT_EQ(game.players[1].points, 28);
  EXPECT_FALSE(stream::WinnerOf(game));
  game.phase = stream::GamePhase::kOver;
  EXPECT_EQ(stream::WinnerOf(game), 0u);
  game.results[1].runner_points = 27;
  AddUp(game);
  EXPECT_FALSE(stream::WinnerOf(game));  // A draw.
}

}  // namespace
}  // namespace footing::game
