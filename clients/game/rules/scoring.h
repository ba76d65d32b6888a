#pragma once

#include "clients/game/rules/facts.h"
#include "common/stream/game.h"

/// Points, from published facts alone. The paper had no score; docs/game.md has the rules.
namespace footing::game {

/// Of the runner.
inline constexpr double kPointsPerM = 1;
inline constexpr double kPointsPerFailure = -5;
inline constexpr double kPointsPerDifficulty = 3;
/// Of the builder, for the first failure on one of their segments: a fall, and leaving the ribbon.
/// Pits are not part of the paper's game, and easier to lay than to clear.
inline constexpr double kPointsPerFall = 10;
inline constexpr double kPointsPerExit = 8;
inline constexpr double kPointsPerPit = 5;
/// A second failure on one segment counts half for the builder; one more counts for nobody, since
/// what fails three times cannot be passed.
inline constexpr double kSecondShare = 0.5;
inline constexpr int kMostFailuresThatCount = 2;

/// 0 for level straight ground; each of slope, curve and step adds 1 at its limit, a pit adds 1
/// and its length over 1.5 m.
double DifficultyOf(const Stretch& stretch);

/// The round's points, in whole numbers, and what they come from. The runner has at least 0.
stream::GameRound Score(const RoundFacts& facts);

/// Adds up the players' points over the results.
void AddUp(stream::GameState& game);

}  // namespace footing::game
