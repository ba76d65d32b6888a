#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "common/stream/game.h"

/// The terrain game as a person reads it.
namespace footing::scene {

/// Whether somebody plays; or has played, and no other trial has begun since. `trial` may be null.
bool ShowsGame(const stream::GameState& game, const stream::TrialState* trial);

/// What happens: "Round 1 of 2", "Round 2 of 2 begins", "Change the controllers over", "Ben wins".
std::string GameTitle(const stream::GameState& game);

/// Time left, "0:42"; empty where nothing runs out.
std::string GameClock(const stream::GameState& game);

/// What the player does now, "runs" or "builds"; empty between rounds.
std::string PartText(const stream::GameState& game, std::size_t player);

/// How the round stands: "23.4 m, 7 of 9 segments passed, failures 2 (curve 2)"; empty before the
/// first one.
std::string RoundText(const stream::GameState& game);

/// What the builder holds: "next: up 3.2 deg, left 8 deg"; "next: level"; empty without a ghost.
std::string GhostText(const stream::GameState& game);

/// All of it in one line, and a line each.
std::string GameLine(const stream::GameState& game);
std::vector<std::string> GameLines(const stream::GameState& game);

}  // namespace footing::scene
