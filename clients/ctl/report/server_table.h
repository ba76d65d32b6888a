#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "common/stream/server_stats.h"

namespace footing::ctl::display {

/// How a server fares: {uptime_s, ticks: {...}, session_count, ..., sessions: [...], devices:
/// [...]}. What is unknown is null.
nlohmann::ordered_json ServerStatsToJson(const stream::ServerStats& stats);

/// One line: ticks, overload, sessions.
std::string ServerLine(const stream::ServerStats& stats);

/// A line a session: who it is, what waits for it, what it lost; empty without a session.
std::string SessionTable(const stream::ServerStats& stats);

}  // namespace footing::ctl::display
