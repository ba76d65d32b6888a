#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/stream/track.h"
#include "common/stream/trial.h"

/// The terrain game: one player builds the track ahead of the character that another one runs with
/// (gait paper, section 8.2).
namespace footing::stream {

struct GamePlayer {
  std::string name;
  double points = 0;  ///< Of all rounds, the present one included.
};

/// One round: one player runs, the other one builds.
struct GameRound {
  std::uint32_t runner = 0;  ///< Index of the player who runs.
  std::string trial;         ///< Id of its trial; empty: not started yet.
  double time_s = 0;         ///< Since the start line.
  double distance_m = 0;     ///< Farthest so far, from the start line.
  FailureCounts failures;
  std::uint32_t segments_laid = 0;
  std::uint32_t segments_passed = 0;  ///< Without a failure on them.
  double difficulty = 0;              ///< Sum over the segments passed.
  double runner_points = 0;
  double builder_points = 0;
};

enum class GamePhase {
  kUnspecified = 0,
  kWaiting = 1,    ///< For what the note says.
  kCountdown = 2,  ///< To the next round.
  kRound = 3,
  kPause = 4,  ///< Between two rounds: the players change parts.
  kOver = 5,   ///< All rounds are played.
  kLeft = 6,   ///< The client that led it is gone.
};
/// "waiting", "countdown", "round", "pause", "over", "left".
const char* Name(GamePhase phase);

struct GameState {
  std::string host;  ///< Name of the client that leads it.
  GamePhase phase = GamePhase::kUnspecified;
  double left_s = 0;                  ///< Of the phase; 0: without end.
  std::vector<GamePlayer> players;    ///< Two.
  std::uint32_t rounds = 0;           ///< As many are played.
  std::vector<GameRound> results;     ///< Of the rounds so far; the last one is the present one.
  std::optional<TrackSegment> ghost;  ///< What the builder holds, where it will be laid.
  double ghost_curve_rad = 0;         ///< Left positive.
  double ghost_step_m = 0;            ///< Up positive.
  std::uint32_t refused = 0;          ///< Segments that the track did not take.
  std::string note;                   ///< For a person.
  bool pits = false;                  ///< The builder may lay pits.
};

/// Why a text cannot be the name of a player, as text of static storage; null when it can: 1 to 24
/// bytes of UTF-8 that a terminal shows as one line, without control characters, line separators or
/// changes of writing direction.
const char* WhyNotAPlayerName(std::string_view name);

/// Why a state cannot be that of a game, as text of static storage; null when it can: two players
/// with such names, at most 20 rounds, indices of players below 2, short texts of one line.
const char* WhyNotAGame(const GameState& game);

/// Index of the player with more points, once a game is over; nothing for a draw or before.
std::optional<std::size_t> WinnerOf(const GameState& game);

}  // namespace footing::stream
