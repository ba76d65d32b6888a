#pragma once

#include <boost/asio/io_context.hpp>
#include <memory>
#include <string>
#include <vector>

#include "common/net/metrics_endpoint.h"
#include "common/net/prometheus.h"
#include "common/net/stats_collector.h"
#include "common/base/result.h"

namespace footing::monitoring {

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

}  // namespace footing::monitoring
