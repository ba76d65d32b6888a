#include "common/stream/game.h"

#include <algorithm>
#include <iterator>

#include "common/base/text.h"

namespace footing::stream {
namespace {

constexpr std::size_t kMostNameBytes = 24;
constexpr std::size_t kMostTextBytes = 200;
constexpr std::size_t kMostRounds = 20;
/// Line and paragraph separators, and what turns the direction of all text behind it (UAX 9).
constexpr const char* kLayoutControls[] = {"\u2028", "\u2029", "\u202a", "\u202b",
                                           "\u202c", "\u202d", "\u202e", "\u2066",
                                           "\u2067", "\u2068", "\u2069"};

bool ShowsAsOneLine(std::string_view text) {
  return text::IsPrintable(text) &&
         std::none_of(std::begin(kLayoutControls), std::end(kLayoutControls),
                      [&](const char* one) { return text.find(one) != std::string_view::npos; });
}

}  // namespace

const char* WhyNotAPlayerName(std::string_view name) {
  if (name.empty() || name.size() > kMostNameBytes)
    return "a player's name must have 1 to 24 bytes";
  return ShowsAsOneLine(name) ? nullptr
                              : "a player's name must be printable UTF-8 text, without control "
                                "characters or changes of writing direction";
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
  if (!ShowsAsOneLine(game.host) || !ShowsAsOneLine(game.note)) {
    return "host and note must be printable UTF-8 text";
  }
  return nullptr;
}

std::optional<std::size_t> WinnerOf(const GameState& game) {
  if (game.phase != GamePhase::kOver || game.players.size() != 2) return std::nullopt;
  if (game.players[0].points == game.players[1].points) return std::nullopt;
  return game.players[0].points > game.players[1].points ? 0 : 1;
}

}  // namespace footing::stream
