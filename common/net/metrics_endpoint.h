#pragma once

#include <boost/asio/io_context.hpp>
#include <functional>
#include <memory>
#include <string>

#include "common/base/result.h"
#include "common/net/address.h"

namespace footing::http_server {
class Server;
}

namespace footing::monitoring {

/// Answers GET /metrics over HTTP, one request a connection: on TCP of this host, where a
/// Prometheus server reads them, or on a Unix socket. HTTP/1.0 and 1.1. Nothing else is understood
/// there: who reads metrics can send no command.
///
/// At most 8 connections are open at once; more are closed at once. Each ends after 5 s. A request
/// may have 4 KiB of header and no body. Everything runs on the io_context's one thread.
class MetricsEndpoint {
 public:
  /// Usage error for an address that is neither unix:PATH nor fd:NAME nor tcp: of loopback.
  static Result<void> Check(const std::string& address);
  /// Listens on `address` (Check); a Unix socket has mode 0660. `text` gives the page.
  static Result<std::unique_ptr<MetricsEndpoint>> Open(boost::asio::io_context& io,
                                                       const std::string& address,
                                                       std::function<std::string()> text);
  ~MetricsEndpoint();
  /// Where it really listens.
  const transport::Address& address() const;
  MetricsEndpoint(const MetricsEndpoint&) = delete;
  MetricsEndpoint& operator=(const MetricsEndpoint&) = delete;

 private:
  explicit MetricsEndpoint(std::unique_ptr<http_server::Server> server);
  std::unique_ptr<http_server::Server> server_;
};

}  // namespace footing::monitoring
