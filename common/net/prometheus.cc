#include "common/net/prometheus.h"

#include <vector>

#include "common/net/metrics_writer.h"

namespace footing::monitoring {
namespace {

std::string Of(const stream::SessionStats& session) {
  return Braced({{"session", std::to_string(session.session)},
                 {"client", session.client_name},
                 {"role", session.role}});
}

std::string Of(const stream::DeviceStats& device) {
  return Braced({{"serial", device.serial},
                 {"kind", stream::Name(device.kind)},
                 {"rig", device.rig},
                 {"role", stream::Name(device.role)},
                 {"simulated", device.simulated ? "true" : "false"}});
}

void WriteServer(const stream::ServerStats& stats, MetricsWriter& to) {
  to.Gauge("footing_uptime_seconds", "Time since the first tick.");
  to.Sample(stats.uptime_s);
  to.Counter("footing_ticks_total", "Ticks published.");
  to.Sample(stats.ticks.ticks);
  to.Gauge("footing_tick_rate_hertz", "Ticks per second, over the last second.");
  to.Sample(stats.ticks.rate_hz);
  to.Gauge("footing_tick_late_max_seconds", "Largest delay of a tick in the last second.");
  to.Sample(stats.ticks.late_max_s);
  to.Counter("footing_tick_overruns_total",
             "Ticks or simulation steps that began more than a period late.");
  to.Sample(stats.ticks.overruns);
  to.Counter("footing_ticks_left_out_total", "Ticks skipped because of overload.");
  to.Sample(stats.ticks.left_out);
  to.Counter("footing_ticks_dropped_total", "Ticks dropped because a session's queue was full.");
  to.Sample(stats.ticks_dropped);
  to.Counter("footing_channels_left_out_total", "Channels that did not fit into a tick.");
  to.Sample(stats.channels_left_out);
  to.Gauge("footing_ring_bytes", "Size of the ring of past ticks.");
  to.Sample(stats.ring_bytes);
  to.Gauge("footing_sessions", "Current sessions.");
  to.Sample(stats.session_count);
  to.Counter("footing_connections_accepted_total", "Connections accepted.");
  to.Sample(stats.sessions_accepted);
  to.Counter("footing_connections_refused_total", "Connections refused.");
  to.Sample(stats.sessions_refused);
  to.Counter("footing_budget_refusals_total", "Times that a session waited for its rate limit.");
  to.Sample(stats.slowed);
}

void WriteSessions(const std::vector<stream::SessionStats>& sessions, MetricsWriter& to) {
  if (sessions.empty()) return;
  to.Gauge("footing_session_queue_ticks", "Ticks waiting for the session.");
  for (const auto& one : sessions) to.Sample(std::uint64_t{one.queue_ticks}, Of(one));
  to.Gauge("footing_session_lag_seconds", "Age of the oldest waiting tick.");
  for (const auto& one : sessions) to.Sample(one.lag_s, Of(one));
  to.Counter("footing_session_ticks_sent_total", "Ticks handed to the session's socket.");
  for (const auto& one : sessions) to.Sample(one.ticks_sent, Of(one));
  to.Counter("footing_session_ticks_dropped_total",
             "Ticks dropped because the session's queue was full.");
  for (const auto& one : sessions) to.Sample(one.ticks_dropped, Of(one));
  to.Counter("footing_session_budget_refusals_total",
             "Times that the session waited for its rate limit.");
  for (const auto& one : sessions) to.Sample(one.slowed, Of(one));
  to.Gauge("footing_session_clock_offset_seconds", "The client's clock minus the server's.");
  for (const auto& one : sessions) {
    if (one.clock_valid) to.Sample(one.clock_offset_s, Of(one));
  }
}

void WriteDevices(const std::vector<stream::DeviceStats>& devices, MetricsWriter& to) {
  if (devices.empty()) return;
  to.Gauge("footing_device_live", "1 while data reports arrive.");
  for (const auto& one : devices) {
    to.Sample(std::uint64_t{one.state == stream::DeviceState::kLive ? 1u : 0u}, Of(one));
  }
  to.Gauge("footing_device_report_rate_hertz", "Reports per second.");
  for (const auto& one : devices) to.Sample(one.report_rate_hz, Of(one));
  to.Gauge("footing_device_jitter_seconds", "Standard deviation of the interval between reports.");
  for (const auto& one : devices) to.Sample(one.jitter_s, Of(one));
  to.Counter("footing_device_reports_total", "Reports received.");
  for (const auto& one : devices) to.Sample(one.reports, Of(one));
  to.Counter("footing_device_gaps_total",
             "Intervals between reports of more than five times the nominal one.");
  for (const auto& one : devices) to.Sample(one.gaps, Of(one));
  to.Counter("footing_device_queue_drops_total", "Reports lost before they were decoded.");
  for (const auto& one : devices) to.Sample(one.queue_drops, Of(one));
  to.Counter("footing_device_undecodable_total", "Reports that could not be decoded.");
  for (const auto& one : devices) to.Sample(one.undecodable, Of(one));
  to.Counter("footing_device_writes_failed_total", "Output reports that could not be written.");
  for (const auto& one : devices) to.Sample(one.writes_failed, Of(one));
  to.Gauge("footing_device_battery_ratio", "Battery charge, 0 to 1.");
  for (const auto& one : devices) {
    if (one.battery_fraction >= 0) to.Sample(one.battery_fraction, Of(one));
  }
}

}  // namespace

std::string PrometheusText(const stream::ServerStats& stats, const Program& program,
                           const ProcessUsage& usage) {
  MetricsWriter to;
  WriteProgram(program, to);
  WriteServer(stats, to);
  WriteSessions(stats.sessions, to);
  WriteDevices(stats.devices, to);
  WriteProcess(usage, to);
  return to.Take();
}

}  // namespace footing::monitoring
