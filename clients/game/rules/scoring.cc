#include "clients/game/rules/scoring.h"

#include <algorithm>
#include <cmath>

#include "common/base/units.h"

namespace footing::game {
namespace {

double BuilderPoints(stream::FailureCause cause) {
  switch (cause) {
    case stream::FailureCause::kSimulation:
    case stream::FailureCause::kTransition:
      return kPointsPerFall;
    case stream::FailureCause::kCurve:
    case stream::FailureCause::kStraightness:
      return kPointsPerExit;
    case stream::FailureCause::kJump:
      return kPointsPerPit;
    case stream::FailureCause::kUnspecified:
      return 0;
  }
  return 0;
}

/// Index of the laid segment at a distance; -1 before the first one.
int StretchAt(const RoundFacts& facts, double distance_m) {
  int found = -1;
  for (const Stretch& stretch : facts.laid) {
    if (stretch.from_m > distance_m) break;
    ++found;
  }
  return found;
}

}  // namespace

double DifficultyOf(const Stretch& stretch) {
  if (stretch.pit) return 1 + stretch.length_m / 1.5;
  return std::fabs(stretch.slope_rad) / DegreesToRadians(5) +
         std::fabs(stretch.curve_rad) / DegreesToRadians(15) + std::fabs(stretch.step_m) / 0.10;
}

stream::GameRound Score(const RoundFacts& facts) {
  stream::GameRound round;
  round.time_s = facts.time_s;
  round.distance_m = std::max(0.0, facts.farthest_m - facts.start_m);
  round.segments_laid = static_cast<std::uint32_t>(facts.laid.size());
  std::map<int, int> failures;  // By index of the segment; -1: the start, which nobody laid.
  int counted = 0;
  for (const auto& [number, fault] : facts.faults) {
    if (fault.withdrawn) continue;
    if (std::uint64_t* const count = stream::MutableCountOf(fault.cause, round.failures)) ++*count;
    const int index = StretchAt(facts, fault.distance_m);
    const int before = failures[index]++;
    if (before >= kMostFailuresThatCount) continue;
    ++counted;
    if (index >= 0) {
      round.builder_points += BuilderPoints(fault.cause) * (before == 0 ? 1 : kSecondShare);
    }
  }
  for (std::size_t i = 0; i < facts.laid.size(); ++i) {
    const Stretch& stretch = facts.laid[i];
    const bool behind = stretch.from_m + stretch.length_m <= facts.farthest_m;
    if (!behind || failures.contains(static_cast<int>(i))) continue;
    ++round.segments_passed;
    round.difficulty += DifficultyOf(stretch);
  }
  const double points = kPointsPerM * round.distance_m + kPointsPerFailure * counted +
                        kPointsPerDifficulty * round.difficulty;
  round.runner_points = std::round(std::max(0.0, points));
  round.builder_points = std::round(round.builder_points);
  return round;
}

void AddUp(stream::GameState& game) {
  for (std::size_t i = 0; i < game.players.size(); ++i) {
    game.players[i].points = 0;
    for (const stream::GameRound& round : game.results) {
      game.players[i].points += round.runner == i ? round.runner_points : round.builder_points;
    }
  }
}

}  // namespace footing::game
