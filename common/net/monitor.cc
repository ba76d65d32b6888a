#include "common/net/monitor.h"

#include <utility>

#include "common/runtime/log.h"
#include "common/net/process_usage.h"

namespace footing::monitoring {

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

}  // namespace footing::monitoring
