#pragma once

#include <string>

#include "clients/game/rules/facts.h"
#include "common/stream/game.h"

namespace footing::game {

/// What a game has come to.
struct Report {
  stream::GameState game;
  std::uint64_t slopes = 0, curves = 0, steps = 0, pits = 0;  ///< Segments laid that have one.
  double seconds = 0;
};

/// Counts the segments of the game's rounds by what they are.
Report MakeReport(const stream::GameState& game, const Collector& seen, double seconds);

std::string ToJson(const Report& report);

/// The game in one line: "round 1 of 2  12 s left  Ann runs 23.4 m ...".
std::string ToLine(const stream::GameState& game);

/// Each round and the winner, a line each.
std::string ToText(const Report& report);

}  // namespace footing::game
