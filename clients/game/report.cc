#include "clients/game/report.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "common/base/number.h"
#include "common/base/units.h"

namespace footing::game {
namespace {

using nlohmann::ordered_json;

/// Less is not a slope, curve or step that anybody made.
constexpr double kLeast = 1e-6;

ordered_json Failures(const stream::FailureCounts& counts) {
  ordered_json failures;
  for (const stream::FailureCause cause : stream::kFailureCauses) {
    failures[stream::Name(cause)] = stream::CountOf(cause, counts);
  }
  return failures;
}

ordered_json RoundOf(const stream::GameState& game, const stream::GameRound& round) {
  return {{"runner", game.players[round.runner].name},
          {"builder", game.players[1 - round.runner].name},
          {"trial", round.trial},
          {"time_s", round.time_s},
          {"distance_m", round.distance_m},
          {"failures", Failures(round.failures)},
          {"segments_laid", round.segments_laid},
          {"segments_passed", round.segments_passed},
          {"difficulty", round.difficulty},
          {"runner_points", round.runner_points},
          {"builder_points", round.builder_points}};
}

std::string PlayerText(const stream::GameState& game, std::size_t player, const char* does,
                       double points) {
  return game.players[player].name + " " + does + " " + text::Fixed(points, 0);
}

}  // namespace

Report MakeReport(const stream::GameState& game, const Collector& seen, double seconds) {
  Report report;
  report.game = game;
  report.seconds = seconds;
  for (const stream::GameRound& round : game.results) {
    const RoundFacts* const facts = seen.Find(round.trial);
    if (facts == nullptr) continue;
    for (const Stretch& stretch : facts->laid) {
      report.slopes += std::fabs(stretch.slope_rad) > kLeast;
      report.curves += std::fabs(stretch.curve_rad) > kLeast;
      report.steps += std::fabs(stretch.step_m) > kLeast;
      report.pits += stretch.pit;
    }
  }
  return report;
}

std::string ToJson(const Report& report) {
  const stream::GameState& game = report.game;
  ordered_json players = ordered_json::array();
  for (const stream::GamePlayer& player : game.players) {
    players.push_back({{"name", player.name}, {"points", player.points}});
  }
  ordered_json rounds = ordered_json::array();
  for (const stream::GameRound& round : game.results) rounds.push_back(RoundOf(game, round));
  const auto winner = stream::WinnerOf(game);
  return ordered_json{{"seconds", report.seconds},
                      {"phase", stream::Name(game.phase)},
                      {"players", players},
                      {"rounds", rounds},
                      {"winner", winner ? game.players[*winner].name : ""},
                      {"slopes", report.slopes},
                      {"curves", report.curves},
                      {"steps", report.steps},
                      {"pits", report.pits},
                      {"segments_refused", game.refused}}
      .dump();
}

std::string ToLine(const stream::GameState& game) {
  std::string line = stream::Name(game.phase);
  if (game.phase == stream::GamePhase::kRound) {
    line += " " + std::to_string(game.results.size()) + " of " + std::to_string(game.rounds);
  }
  if (game.left_s > 0) line += "  " + text::Fixed(std::ceil(game.left_s), 0) + " s left";
  if (!game.results.empty()) {
    const stream::GameRound& round = game.results.back();
    line += "  " + PlayerText(game, round.runner, "runs", round.runner_points) + "  " +
            PlayerText(game, 1 - round.runner, "builds", round.builder_points) + "  " +
            text::Fixed(round.distance_m, 1) + " m  failures " +
            std::to_string(stream::Total(round.failures));
  }
  if (game.ghost) {
    line += "  next: slope " + text::Fixed(RadiansToDegrees(game.ghost->slope_rad), 1) +
            " deg, curve " + text::Fixed(RadiansToDegrees(game.ghost_curve_rad), 1) +
            " deg, step " + text::Fixed(100 * game.ghost_step_m, 1) + " cm";
    if (game.ghost->pit) line += ", pit";
  }
  return game.note.empty() ? line : line + "  (" + game.note + ")";
}

std::string ToText(const Report& report) {
  std::string text;
  for (std::size_t i = 0; i < report.game.results.size(); ++i) {
    const stream::GameRound& round = report.game.results[i];
    text += "round " + std::to_string(i + 1) + ": " +
            PlayerText(report.game, round.runner, "ran", round.runner_points) + ", " +
            PlayerText(report.game, 1 - round.runner, "built", round.builder_points) + "; " +
            text::Fixed(round.distance_m, 1) + " m, " +
            std::to_string(stream::Total(round.failures)) + " failures, " +
            std::to_string(round.segments_passed) + " of " + std::to_string(round.segments_laid) +
            " segments passed\n";
  }
  for (const stream::GamePlayer& player : report.game.players) {
    text += player.name + ": " + text::Fixed(player.points, 0) + " points\n";
  }
  if (report.game.phase != stream::GamePhase::kOver) return text + "the game did not end\n";
  const auto winner = stream::WinnerOf(report.game);
  return text + (winner ? report.game.players[*winner].name + " wins\n" : "a draw\n");
}

}  // namespace footing::game
