#pragma once

#include <cstdint>
#include <initializer_list>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <boost/asio/io_context.hpp>

#include "common/base/result.h"
#include "common/net/metrics_endpoint.h"
#include "common/net/server.h"
#include "common/stream/device.h"
#include "common/stream/server_stats.h"

namespace footing::monitoring {

/// Usage of the host by this process.
struct ProcessUsage {
  double cpu_s = 0;  ///< User and system.
  std::uint64_t resident_bytes = 0;
  std::uint64_t open_descriptors = 0;
};

/// From getrusage(2) and /proc/self; what is not to be had there is 0.
ProcessUsage UsageOfThisProcess();

/// Whose stats they are.
struct Program {
  std::string name;
  std::string version;
};

/// The stats in Prometheus' text format 0.0.4: base units, counters end in _total, a line # HELP
/// and # TYPE each. What is unknown (a battery, a clock) has no line.
std::string PrometheusText(const stream::ServerStats& stats, const Program& program,
                           const ProcessUsage& usage);

/// The channel `stats`, which every server has.
transport::Channel StatsChannel();

/// One tick that is about to be published.
struct TickInstant {
  std::int64_t now_ns = 0;
  /// When it was due; none: one period after the tick before it.
  std::optional<std::int64_t> due_ns;
  /// Overruns by the server's own count; none: the ticks more than a period late are counted here.
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

/// How a server fares, published in its ticks and, where an address is given, served as metrics.
/// Everything runs on the server's thread.
class Monitor {
 public:
  /// The server outlives it, and has StatsChannel().
  Monitor(const transport::Server& server, double tick_rate_hz, Program program);

  /// Serves metrics on an address of MetricsEndpoint; nowhere when it is empty.
  Result<void> Serve(boost::asio::io_context& io, const std::string& address);
  /// No metrics any more.
  void Stop() { endpoint_.reset(); }

  /// As StatsCollector.
  void SetDevices(const std::vector<stream::DeviceStatus>& devices) {
    collector_.SetDevices(devices);
  }
  void OnTick(const TickInstant& tick, std::vector<transport::ChannelBytes>& channels) {
    collector_.OnTick(tick, channels);
  }

 private:
  StatsCollector collector_;
  const Program program_;
  std::unique_ptr<MetricsEndpoint> endpoint_;
};

/// A label of a metric's sample.
struct Label {
  const char* name;
  std::string value;
};

/// Labels of a sample: {name="value",...}.
std::string Braced(std::initializer_list<Label> labels);

/// Writes metrics in Prometheus' text format 0.0.4: a line # HELP and # TYPE each, then samples.
class MetricsWriter {
 public:
  /// Begins a metric; its samples follow. Base units; the name of a counter ends in _total.
  void Gauge(const char* name, const char* help) { Begin(name, help, "gauge"); }
  void Counter(const char* name, const char* help) { Begin(name, help, "counter"); }

  /// A value that is not finite is written as 0.
  void Sample(double value, const std::string& labels = "");
  void Sample(std::uint64_t value, const std::string& labels = "");

  std::string Take();

 private:
  void Begin(const char* name, const char* help, const char* type);

  std::string name_;
  std::string text_;
};

/// footing_build_info, and process_* as other programs have them.
void WriteProgram(const Program& program, MetricsWriter& to);
void WriteProcess(const ProcessUsage& usage, MetricsWriter& to);

}  // namespace footing::monitoring
