#include "common/stream/game.h"

#include <algorithm>

namespace footing::stream {
namespace {

constexpr std::size_t kMostNameBytes = 24;
constexpr std::size_t kMostTextBytes = 200;
constexpr std::size_t kMostRounds = 20;

}  // namespace

const char* Name(GamePhase phase) {
  switch (phase) {
    case GamePhase::kUnspecified:
      return "unspecified";
    case GamePhase::kWaiting:
      return "waiting";
    case GamePhase::kCountdown:
      return "countdown";
    case GamePhase::kRound:
      return "round";
    case GamePhase::kPause:
      return "pause";
    case GamePhase::kOver:
      return "over";
    case GamePhase::kLeft:
      return "left";
  }
  return "unspecified";
}

const char* WhyNotAPlayerName(std::string_view name) {
  return name.empty() || name.size() > kMostNameBytes ? "a player's name must have 1 to 24 bytes"
                                                      : nullptr;
}

const char* WhyNotAGame(const GameState& game) {
  if (game.phase == GamePhase::kUnspecified) return "the phase is missing";
  if (game.players.size() != 2) return "there must be two players";
  for (const GamePlayer& player : game.players) {
    const char* const why = WhyNotAPlayerName(player.name);
    if (why != nullptr) return why;
  }
  if (game.rounds < 1 || game.rounds > kMostRounds || game.results.size() > game.rounds) {
    return "there must be 1 to 20 rounds, and no more results than rounds";
  }
  for (const GameRound& round : game.results) {
    if (round.runner > 1 || round.trial.size() > kMostTextBytes) {
      return "a round's runner must be 0 or 1, and its trial an id";
    }
  }
  if (std::max(game.host.size(), game.note.size()) > kMostTextBytes) {
    return "host and note must have at most 200 bytes";
  }
  return nullptr;
}

std::optional<std::size_t> WinnerOf(const GameState& game) {
  if (game.phase != GamePhase::kOver || game.players.size() != 2) return std::nullopt;
  if (game.players[0].points == game.players[1].points) return std::nullopt;
  return game.players[0].points > game.players[1].points ? 0 : 1;
}

}  // namespace footing::stream
