#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "common/stream/device.h"
#include "common/stream/sensor.h"
#include "common/stream/server_stats.h"

namespace footing::ctl::display {

/// Content of the watch screen: the newest status and samples of every device. A plain value.
struct Live {
  struct Newest {
    std::optional<stream::MotionSample> motion;
    std::optional<stream::NunchukSample> nunchuk;
    std::optional<stream::GamepadSample> gamepad;
    std::optional<stream::BoardSample> board;
    std::uint64_t samples = 0;  ///< Since the watch began; of a gamepad where it has no motion.
  };
  std::vector<stream::DeviceStatus> devices;
  std::map<std::uint32_t, Newest> newest;     ///< By device number.
  std::string link;                           ///< How the connection stands.
  bool lost = false;                          ///< It does not stand: what is below is old.
  std::optional<stream::ServerStats> server;  ///< How it fares.
  std::string notice;                         ///< Cause that slows the server; empty: none.

  void Take(const stream::MotionSample& sample);
  void Take(const stream::NunchukSample& sample);
  void Take(const stream::GamepadSample& sample);
  void Take(const stream::BoardSample& sample);
};

/// One screen: a table of the devices and below it what each measures, boards as bars in kg.
std::string LiveScreen(const Live& live);
/// One line, for a log.
std::string LiveLine(const Live& live);
/// {seconds, devices: [...]}, each with its newest sample as "motion", "nunchuk", "gamepad" or
/// "board".
nlohmann::ordered_json LiveToJson(const Live& live, double seconds);

/// How a server fares: {uptime_s, ticks: {...}, session_count, ..., sessions: [...], devices:
/// [...]}. What is unknown is null.
nlohmann::ordered_json ServerStatsToJson(const stream::ServerStats& stats);

/// One line: ticks, overload, sessions.
std::string ServerLine(const stream::ServerStats& stats);

/// A line a session: who it is, what waits for it, what it lost; empty without a session.
std::string SessionTable(const stream::ServerStats& stats);

// Small pieces of text for a terminal. No locale.

/// "1.5"; decimals 0 to 9. What is not finite is "-".
std::string Fixed(double value, int decimals);

/// UNIX time as "2026-11-21 10:15 UTC"; "-" for 0.
std::string Date(std::int64_t wall_time_ns);

/// The first row is the heading. Columns stand two spaces apart, numbers to the right; no blanks at
/// the end of a line.
std::string Table(const std::vector<std::vector<std::string>>& rows);

/// `value` of `full` as `cells` characters of '#' and '.'; clipped to the bar.
std::string Bar(double value, double full, int cells);

/// Bits 0 to 3 as "1010", first lamp first.
std::string Lamps(std::uint32_t leds);

}  // namespace footing::ctl::display
