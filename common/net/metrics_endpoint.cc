#include "common/net/metrics_endpoint.h"

#include <utility>

#include "common/net/http_server.h"

namespace footing::monitoring {
namespace {

namespace http = boost::beast::http;

http_server::Answer AnswerTo(const http_server::Request* request,
                             const std::function<std::string()>& text) {
  static const std::string kType = "text/plain; version=0.0.4; charset=utf-8";
  if (request == nullptr)
    return {http::status::bad_request, kType, "not an HTTP request; use GET /metrics\n"};
  if (request->method() != http::verb::get)
    return {http::status::method_not_allowed, kType, "only GET is supported\n"};
  if (request->target() != "/metrics" && request->target() != "/")
    return {http::status::not_found, kType, "not found; use /metrics\n"};
  return {http::status::ok, kType, text()};
}

}  // namespace

Result<void> MetricsEndpoint::Check(const std::string& address) {
  const auto parsed = transport::ParseAddress(address);
  if (!parsed) return parsed.error();
  if (parsed->kind != transport::Address::Kind::kTls && transport::StaysOnThisHost(*parsed)) {
    return {};
  }
  return UsageError("metrics will not be served on " + address +
                    ": they are neither encrypted nor protected by a token, so they stay on this "
                    "host; use tcp:127.0.0.1:PORT or unix:PATH, with a proxy for other hosts");
}

Result<std::unique_ptr<MetricsEndpoint>> MetricsEndpoint::Open(boost::asio::io_context& io,
                                                               const std::string& address,
                                                               std::function<std::string()> text) {
  if (const auto checked = Check(address); !checked) return checked.error();
  transport::ListenSecurity security;
  security.passed_in_clear = true;
  auto server = http_server::Server::Open(
      io, *transport::ParseAddress(address),
      {.headers = {{"Allow", "GET"}},
       .answer = [text = std::move(text)](
                     const http_server::Request* request) { return AnswerTo(request, text); }},
      security);
  if (!server) return server.error();
  return std::unique_ptr<MetricsEndpoint>(new MetricsEndpoint(std::move(*server)));
}

MetricsEndpoint::MetricsEndpoint(std::unique_ptr<http_server::Server> server)
    : server_(std::move(server)) {}
MetricsEndpoint::~MetricsEndpoint() = default;
const transport::Address& MetricsEndpoint::address() const { return server_->address(); }

}  // namespace footing::monitoring
