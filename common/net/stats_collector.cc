#include "common/net/stats_collector.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "common/base/time.h"
#include "common/base/units.h"
#include "common/wire/wire.h"
#include "footing/v1/session.pb.h"

namespace footing::monitoring {
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

}  // namespace footing::monitoring
