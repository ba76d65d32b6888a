#include "common/net/monitoring.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <system_error>
#include <tuple>
#include <utility>
#include <vector>

#include <sys/resource.h>
#include <unistd.h>

#include "common/base/text.h"
#include "common/base/units.h"
#include "common/runtime/log.h"
#include "common/wire/wire.h"
#include "footing/v1/session.pb.h"

namespace footing::monitoring {
namespace {

double Seconds(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

}  // namespace

ProcessUsage UsageOfThisProcess() {
  ProcessUsage usage;
  rusage used{};
  if (getrusage(RUSAGE_SELF, &used) == 0) {
    usage.cpu_s = Seconds(used.ru_utime) + Seconds(used.ru_stime);
  }
  std::ifstream pages("/proc/self/statm");  // Total and resident, in pages.
  std::uint64_t total = 0, resident = 0;
  if (pages >> total >> resident) {
    usage.resident_bytes = resident * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
  }
  std::error_code error;
  const std::filesystem::directory_iterator descriptors("/proc/self/fd", error);
  if (!error) {
    const auto listed = std::distance(begin(descriptors), end(descriptors));
    usage.open_descriptors = static_cast<std::uint64_t>(listed - 1);  // Without the listing's own.
  }
  return usage;
}

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

namespace {

constexpr std::uint32_t kField = v1::Tick::kStatsFieldNumber;
/// A little below a second: ticks come every 10 ms, and one that is early must not wait for the
/// next.
constexpr std::int64_t kIntervalNs = 995'000'000;

}  // namespace

transport::Channel StatsChannel() { return {"stats", kField, true}; }

StatsCollector::StatsCollector(const transport::Server& server, double tick_rate_hz)
    : server_(server), period_ns_(PeriodNanoseconds(tick_rate_hz)) {}

void StatsCollector::SetDevices(const std::vector<stream::DeviceStatus>& devices) {
  stats_.devices.clear();
  for (const stream::DeviceStatus& status : devices) {
    stream::DeviceStats device;
    device.device = status.device;
    device.serial = status.serial;
    device.kind = status.kind;
    device.state = status.state;
    device.rig = status.rig;
    device.role = status.role;
    device.simulated = status.simulated;
    device.report_rate_hz = status.report_rate_hz;
    device.jitter_s = status.jitter_ms * 1e-3;
    device.reports = status.reports;
    device.gaps = status.gaps;
    device.queue_drops = status.queue_drops;
    device.undecodable = status.undecodable;
    device.writes_failed = status.writes_failed;
    device.battery_fraction = status.battery_fraction;
    stats_.devices.push_back(std::move(device));
  }
}

void StatsCollector::OnTick(const TickInstant& tick,
                            std::vector<transport::ChannelBytes>& channels) {
  const bool first = began_ns_ == 0;
  if (first) began_ns_ = tick.now_ns;
  const std::int64_t due_ns =
      first ? tick.now_ns : tick.due_ns.value_or(last_tick_ns_ + period_ns_);
  last_tick_ns_ = tick.now_ns;
  late_max_s_ = std::max(late_max_s_, NanosecondsToSeconds(tick.now_ns - due_ns));
  if (tick.overruns) {
    stats_.ticks.overruns = *tick.overruns;
  } else if (tick.now_ns - due_ns > period_ns_) {
    ++stats_.ticks.overruns;
  }
  ++stats_.ticks.ticks;
  if (!first && tick.now_ns - collected_ns_ < kIntervalNs) return;
  Collect(tick.now_ns);
  channels.push_back({kField, wire::ToProto(stats_).SerializeAsString()});
}

void StatsCollector::Collect(std::int64_t now_ns) {
  const auto ticks = static_cast<double>(stats_.ticks.ticks - ticks_then_);
  const double passed_s = NanosecondsToSeconds(now_ns - collected_ns_);
  stats_.ticks.rate_hz = collected_ns_ == 0 || passed_s <= 0 ? 0 : ticks / passed_s;
  stats_.ticks.late_max_s = std::exchange(late_max_s_, 0);
  ticks_then_ = stats_.ticks.ticks;
  collected_ns_ = now_ns;

  const transport::ServerStatistics server = server_.statistics();
  stats_.uptime_s = NanosecondsToSeconds(now_ns - began_ns_);
  stats_.ticks.left_out = server.late_ticks;
  stats_.session_count = server.sessions;
  stats_.sessions_accepted = server.accepted;
  stats_.sessions_refused = server.refused;
  stats_.ticks_dropped = server.ticks_dropped;
  stats_.slowed = server.slowed;
  stats_.channels_left_out = server.channels_left_out;
  stats_.ring_bytes = server.ring_bytes;
  stats_.sessions = MostLagging(server_.sessions(), kMostSessions);
}

std::vector<stream::SessionStats> MostLagging(std::vector<stream::SessionStats> sessions,
                                              std::size_t most) {
  const auto worse = [](const stream::SessionStats& a, const stream::SessionStats& b) {
    return std::tuple(-a.lag_s, b.ticks_dropped, a.session) <
           std::tuple(-b.lag_s, a.ticks_dropped, b.session);
  };
  const std::size_t kept = std::min(most, sessions.size());
  std::partial_sort(sessions.begin(), sessions.begin() + static_cast<std::ptrdiff_t>(kept),
                    sessions.end(), worse);
  sessions.resize(kept);
  return sessions;
}

Monitor::Monitor(const transport::Server& server, double tick_rate_hz, Program program)
    : collector_(server, tick_rate_hz), program_(std::move(program)) {}

Result<void> Monitor::Serve(boost::asio::io_context& io, const std::string& address) {
  if (address.empty()) return {};
  auto opened = MetricsEndpoint::Open(io, address, [this] {
    return PrometheusText(collector_.newest(), program_, UsageOfThisProcess());
  });
  if (!opened) return opened.error();
  endpoint_ = std::move(*opened);
  log::Info("metrics on " + endpoint_->address().Text());
  return {};
}

namespace {

/// As the format wants a label's value: a backslash, a quote and the end of a line are escaped.
std::string Escaped(const std::string& value) {
  std::string text;
  for (const char c : value) {
    if (c == '\\' || c == '"') text += '\\';
    text += c == '\n' ? std::string("\\n") : std::string(1, c);
  }
  return text;
}

}  // namespace

std::string Braced(std::initializer_list<Label> labels) {
  std::string text;
  for (const Label& label : labels) {
    text +=
        (text.empty() ? "{" : ",") + std::string(label.name) + "=\"" + Escaped(label.value) + "\"";
  }
  return text + "}";
}

void MetricsWriter::Sample(double value, const std::string& labels) {
  text_ += name_ + labels + ' ';
  text::AppendShortest(text_, std::isfinite(value) ? value : 0);
  text_ += '\n';
}

void MetricsWriter::Sample(std::uint64_t value, const std::string& labels) {
  text_ += name_ + labels + ' ' + std::to_string(value) + '\n';
}

std::string MetricsWriter::Take() { return std::exchange(text_, {}); }

void MetricsWriter::Begin(const char* name, const char* help, const char* type) {
  name_ = name;
  text_ += "# HELP " + name_ + ' ' + help + "\n# TYPE " + name_ + ' ' + type + '\n';
}

void WriteProgram(const Program& program, MetricsWriter& to) {
  to.Gauge("footing_build_info", "1; the labels say which program this is.");
  to.Sample(std::uint64_t{1}, Braced({{"program", program.name}, {"version", program.version}}));
}

void WriteProcess(const ProcessUsage& usage, MetricsWriter& to) {
  to.Counter("process_cpu_seconds_total", "CPU time of the process, user and system.");
  to.Sample(usage.cpu_s);
  to.Gauge("process_resident_memory_bytes", "Resident memory of the process.");
  to.Sample(usage.resident_bytes);
  to.Gauge("process_open_fds", "Open file descriptors of the process.");
  to.Sample(usage.open_descriptors);
}

}  // namespace footing::monitoring
