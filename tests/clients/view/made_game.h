#pragma once

#include "common/base/units.h"
#include "common/stream/game.h"

namespace footing::scene::made {

/// The first of two rounds: Ann runs, Ben holds a slope in a curve.
inline stream::GameState Game() {
  stream::GameState game;
  game.host = "footing-game";
  game.phase = stream::GamePhase::kRound;
  game.left_s = 41.3;
  game.players = {{"Ann", 38}, {"Ben", 8}};
  game.rounds = 2;
  game.results.resize(1);
  stream::GameRound& round = game.results.back();
  round.trial = "game-1";
  round.time_s = 18.7;
  round.distance_m = 29.9;
  round.failures.curve = 1;
  round.segments_laid = 10;
  round.segments_passed = 6;
  round.runner_points = 38;
  round.builder_points = 8;
  stream::TrackSegment ghost;
  ghost.start_m = {10, 1, 0};
  ghost.heading_rad = -0.14;
  ghost.slope_rad = DegreesToRadians(3.2);
  ghost.length_m = 2.5;
  ghost.width_m = 4;
  game.ghost = ghost;
  game.ghost_curve_rad = -0.14;
  return game;
}

}  // namespace footing::scene::made
