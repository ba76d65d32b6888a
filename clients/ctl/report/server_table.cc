#include "clients/ctl/report/server_table.h"

#include <vector>

#include "clients/ctl/report/format.h"

namespace footing::ctl::display {
namespace {

using nlohmann::ordered_json;

std::string Plural(std::uint64_t count, const std::string& noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

std::string Counted(std::uint64_t count, const std::string& noun, const std::string& what = "") {
  return count == 0 ? "" : ", " + Plural(count, noun) + what;
}

ordered_json KnownOrNull(bool known, double value) {
  return known ? ordered_json(value) : ordered_json(nullptr);
}

ordered_json SessionToJson(const stream::SessionStats& one) {
  return {{"session", one.session},
          {"client", one.client_name},
          {"role", one.role},
          {"local", one.local},
          {"connected_s", one.connected_s},
          {"policy", one.policy},
          {"queue_ticks", one.queue_ticks},
          {"queue_capacity", one.queue_capacity},
          {"lag_s", one.lag_s},
          {"ticks_sent", one.ticks_sent},
          {"ticks_dropped", one.ticks_dropped},
          {"budget_refusals", one.slowed},
          {"clock_offset_s", KnownOrNull(one.clock_valid, one.clock_offset_s)},
          {"clock_uncertainty_s", KnownOrNull(one.clock_valid, one.clock_uncertainty_s)}};
}

ordered_json DeviceToJson(const stream::DeviceStats& one) {
  return {{"device", one.device},
          {"serial", one.serial},
          {"state", stream::Name(one.state)},
          {"report_rate_hz", one.report_rate_hz},
          {"jitter_s", one.jitter_s},
          {"reports", one.reports},
          {"gaps", one.gaps},
          {"queue_drops", one.queue_drops},
          {"undecodable", one.undecodable},
          {"writes_failed", one.writes_failed},
          {"battery_fraction", KnownOrNull(one.battery_fraction >= 0, one.battery_fraction)}};
}

}  // namespace

ordered_json ServerStatsToJson(const stream::ServerStats& stats) {
  ordered_json sessions = ordered_json::array(), devices = ordered_json::array();
  for (const auto& one : stats.sessions) sessions.push_back(SessionToJson(one));
  for (const auto& one : stats.devices) devices.push_back(DeviceToJson(one));
  return {{"uptime_s", stats.uptime_s},
          {"ticks",
           {{"ticks", stats.ticks.ticks},
            {"rate_hz", stats.ticks.rate_hz},
            {"late_max_s", stats.ticks.late_max_s},
            {"overruns", stats.ticks.overruns},
            {"left_out", stats.ticks.left_out}}},
          {"session_count", stats.session_count},
          {"connections_accepted", stats.sessions_accepted},
          {"connections_refused", stats.sessions_refused},
          {"ticks_dropped", stats.ticks_dropped},
          {"budget_refusals", stats.slowed},
          {"channels_left_out", stats.channels_left_out},
          {"ring_bytes", stats.ring_bytes},
          {"sessions", std::move(sessions)},
          {"devices", std::move(devices)}};
}

std::string ServerLine(const stream::ServerStats& stats) {
  return "up " + Fixed(stats.uptime_s, 0) + " s, " + Fixed(stats.ticks.rate_hz, 1) +
         " ticks per second, max delay " + Fixed(1e3 * stats.ticks.late_max_s, 1) + " ms, " +
         Plural(stats.session_count, "session") + Counted(stats.ticks.overruns, "overrun") +
         Counted(stats.ticks.left_out, "tick", " skipped (overload)") +
         Counted(stats.ticks_dropped, "tick", " dropped (queue full)") +
         Counted(stats.slowed, "rate-limit wait") +
         Counted(stats.sessions_refused, "connection", " refused");
}

std::string SessionTable(const stream::ServerStats& stats) {
  if (stats.sessions.empty()) return "";
  std::vector<std::vector<std::string>> rows = {
      {"session", "client", "role", "policy", "queue", "lag ms", "sent", "dropped", "clock ms"}};
  for (const stream::SessionStats& one : stats.sessions) {
    rows.push_back({std::to_string(one.session), one.client_name, one.role,
                    one.policy.empty() ? "-" : one.policy,
                    std::to_string(one.queue_ticks) + "/" + std::to_string(one.queue_capacity),
                    Fixed(1e3 * one.lag_s, 1), std::to_string(one.ticks_sent),
                    std::to_string(one.ticks_dropped),
                    one.clock_valid ? Fixed(1e3 * one.clock_offset_s, 2) + " +-" +
                                          Fixed(1e3 * one.clock_uncertainty_s, 2)
                                    : "-"});
  }
  std::string text = Table(rows);
  if (stats.session_count > stats.sessions.size()) {
    text += "not shown: " + std::to_string(stats.session_count - stats.sessions.size()) +
            " that lag less\n";
  }
  return text;
}

}  // namespace footing::ctl::display
