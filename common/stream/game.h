#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

#include "common/stream/game_state.h"

namespace footing::stream {

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
