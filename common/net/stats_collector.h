#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "common/stream/device.h"
#include "common/stream/server_stats.h"
#include "common/net/server.h"

namespace footing::monitoring {

/// The channel `stats`, which every server has.
transport::Channel StatsChannel();

/// One tick that is about to be published.
struct TickInstant {
  std::int64_t now_ns = 0;
  /// When it was due; none: one period after the tick before it.
  std::optional<std::int64_t> due_ns;
  /// Of the server's own count; none: the ticks more than a period late are counted here.
  std::optional<std::uint64_t> overruns;
};

/// Measures the loop that publishes a server's ticks, and adds how the server fares to one tick a
/// second, the first one included. It runs on the server's thread and reads no clock.
class StatsCollector {
 public:
  static constexpr std::size_t kMostSessions = 32;

  /// The server outlives it.
  StatsCollector(const transport::Server& server, double tick_rate_hz);

  /// The devices as they are now.
  void SetDevices(const std::vector<stream::DeviceStatus>& devices);

  /// Call once a tick; `channels` gets one more when the stats are due.
  void OnTick(const TickInstant& tick, std::vector<transport::ChannelBytes>& channels);

  /// As published last, at most about a second ago.
  const stream::ServerStats& newest() const { return stats_; }

 private:
  void Collect(std::int64_t now_ns);

  const transport::Server& server_;
  const std::int64_t period_ns_;
  std::int64_t began_ns_ = 0;
  std::int64_t last_tick_ns_ = 0;
  std::int64_t collected_ns_ = 0;
  std::uint64_t ticks_then_ = 0;
  double late_max_s_ = 0;
  stream::ServerStats stats_;
};

/// At most `most` of them: those with the greatest lag first, then those that lost most ticks, then
/// the oldest.
std::vector<stream::SessionStats> MostLagging(std::vector<stream::SessionStats> sessions,
                                              std::size_t most);

}  // namespace footing::monitoring
