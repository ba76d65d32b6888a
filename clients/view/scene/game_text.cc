#include "clients/view/scene/game_text.h"

#include <cmath>

#include "clients/view/scene/words.h"
#include "common/base/units.h"

namespace footing::scene {
namespace {

using stream::GamePhase;

std::string RoundTitle(std::size_t number, const stream::GameState& game) {
  return "Round " + std::to_string(number) + " of " + std::to_string(game.rounds);
}

std::string Winner(const stream::GameState& game) {
  const auto winner = stream::WinnerOf(game);
  return winner ? game.players[*winner].name + " wins" : "A draw";
}

std::string ScoreText(const stream::GameState& game, std::size_t player) {
  const std::string part = PartText(game, player);
  return game.players[player].name + (part.empty() ? " " : " (" + part + ") ") +
         Fixed(game.players[player].points, 0);
}

/// "left 8 deg", where there is a curve.
std::string Direction(double value, const char* positive, const char* negative,
                      const std::string& shown) {
  return std::string(value > 0 ? positive : negative) + " " + shown;
}

}  // namespace

bool ShowsGame(const stream::GameState& game, const stream::TrialState* trial) {
  if (game.phase == GamePhase::kUnspecified || game.players.size() != 2) return false;
  if (game.phase != GamePhase::kOver && game.phase != GamePhase::kLeft) return true;
  if (trial == nullptr || trial->trial.empty() || game.results.empty()) return true;
  // What comes after the last round is named after it.
  return trial->trial.ends_with(game.results.back().trial);
}

std::string GameTitle(const stream::GameState& game) {
  const std::size_t begun = game.results.size();
  switch (game.phase) {
    case GamePhase::kUnspecified:
      break;
    case GamePhase::kWaiting:
      return RoundTitle(begun + 1, game);
    case GamePhase::kCountdown:
      return RoundTitle(begun + 1, game) + " begins";
    case GamePhase::kRound:
      return RoundTitle(begun, game);
    case GamePhase::kPause:
      return "Change the controllers over";
    case GamePhase::kOver:
      return Winner(game);
    case GamePhase::kLeft:
      return "The game was left";
  }
  return "";
}

std::string GameClock(const stream::GameState& game) {
  if (!(game.left_s > 0)) return "";
  const auto left_s = static_cast<int>(std::ceil(std::min(game.left_s, 5999.0)));
  const std::string seconds = std::to_string(left_s % 60);
  return std::to_string(left_s / 60) + (seconds.size() < 2 ? ":0" : ":") + seconds;
}

std::string PartText(const stream::GameState& game, std::size_t player) {
  // Before a round: the part in it.
  const bool next = game.phase == GamePhase::kWaiting || game.phase == GamePhase::kCountdown;
  if (next) return game.results.size() % 2 == player ? "runs" : "builds";
  if (game.phase != GamePhase::kRound || game.results.empty()) return "";
  return game.results.back().runner == player ? "runs" : "builds";
}

std::string RoundText(const stream::GameState& game) {
  if (game.results.empty() || game.phase == GamePhase::kOver) return "";
  const stream::GameRound& round = game.results.back();
  return Fixed(round.distance_m, 1) + " m, " + std::to_string(round.segments_passed) + " of " +
         std::to_string(round.segments_laid) + " segments passed, failures " +
         std::to_string(stream::Total(round.failures)) + CauseText(round.failures);
}

std::string GhostText(const stream::GameState& game) {
  if (!game.ghost) return "";
  if (game.ghost->pit) return "next: a pit of " + Fixed(game.ghost->length_m, 1) + " m";
  std::string text;
  const auto add = [&text](const std::string& part) { text += (text.empty() ? "" : ", ") + part; };
  const double slope_deg = RadiansToDegrees(game.ghost->slope_rad);
  const double curve_deg = RadiansToDegrees(game.ghost_curve_rad);
  const double step_cm = 100 * game.ghost_step_m;
  if (std::abs(slope_deg) >= 0.05) {
    add("slope " + Direction(slope_deg, "up", "down", Fixed(std::abs(slope_deg), 1) + " deg"));
  }
  if (std::abs(step_cm) >= 0.05) {
    add("step " + Direction(step_cm, "up", "down", Fixed(std::abs(step_cm), 1) + " cm"));
  }
  if (std::abs(curve_deg) >= 0.5) {
    add("curve " + Direction(curve_deg, "left", "right", Fixed(std::abs(curve_deg), 0) + " deg"));
  }
  return "next: " + (text.empty() ? "level" : text);
}

std::string GameLine(const stream::GameState& game) {
  std::string line = "game: " + GameTitle(game);
  for (const std::string& part : {GameClock(game), ScoreText(game, 0) + " : " + ScoreText(game, 1),
                                  GhostText(game), game.note}) {
    if (!part.empty()) line += "  " + part;
  }
  return line;
}

std::vector<std::string> GameLines(const stream::GameState& game) {
  std::vector<std::string> lines{"Game        " + GameTitle(game) + "   " + GameClock(game),
                                 "  " + ScoreText(game, 0) + " : " + ScoreText(game, 1)};
  for (const std::string& part : {RoundText(game), GhostText(game), game.note}) {
    if (!part.empty()) lines.push_back("  " + part);
  }
  return lines;
}

}  // namespace footing::scene
