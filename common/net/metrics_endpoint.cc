#include "common/net/metrics_endpoint.h"

#include <boost/beast/core/flat_static_buffer.hpp>
#include <boost/beast/http.hpp>
#include <chrono>
#include <utility>

#include "common/net/listener.h"
#include "common/net/socket.h"
#include "common/runtime/timer.h"

namespace footing::monitoring {
namespace {

namespace http = boost::beast::http;
using boost::system::error_code;
using Socket = transport::PlainSocket;

constexpr int kMostConnections = 8;
constexpr auto kLongest = std::chrono::seconds(5);
constexpr std::size_t kMostHeaderBytes = 4096;
constexpr const char* kContentType = "text/plain; version=0.0.4; charset=utf-8";

/// The page and the places that are taken, shared by the connections.
struct Desk {
  std::function<std::string()> text;
  int connections = 0;
  bool closed = false;
};

/// One connection: a request, an answer, and the end.
class Exchange : public std::enable_shared_from_this<Exchange> {
 public:
  Exchange(Socket socket, std::shared_ptr<Desk> desk)
      : socket_(std::move(socket)), deadline_(socket_.get_executor()), desk_(std::move(desk)) {
    ++desk_->connections;
    parser_.header_limit(kMostHeaderBytes);
    parser_.body_limit(0);
  }
  ~Exchange() { --desk_->connections; }

  void Start() {
    deadline_.expires_after(kLongest);
    deadline_.async_wait([weak = weak_from_this()](const error_code& error) {
      const auto self = weak.lock();
      if (!error && self) self->Close();
    });
    http::async_read(
        socket_, buffer_, parser_,
        [self = shared_from_this()](const error_code& error, std::size_t) { self->OnRead(error); });
  }

 private:
  void OnRead(const error_code& error) {
    if (desk_->closed || error == boost::asio::error::operation_aborted) return;
    if (error == http::error::end_of_stream || !socket_.is_open()) return;
    const bool readable = !error;
    answer_.version(readable ? parser_.get().version() : 10);
    answer_.keep_alive(false);
    answer_.set(http::field::content_type, kContentType);
    if (!readable) {
      Answer(http::status::bad_request, "not an HTTP request; use GET /metrics\n");
    } else if (parser_.get().method() != http::verb::get) {
      answer_.set(http::field::allow, "GET");
      Answer(http::status::method_not_allowed, "only GET is supported\n");
    } else if (const auto target = parser_.get().target(); target != "/metrics" && target != "/") {
      Answer(http::status::not_found, "not found; use /metrics\n");
    } else {
      Answer(http::status::ok, desk_->text());
    }
  }

  void Answer(http::status status, std::string body) {
    answer_.result(status);
    answer_.body() = std::move(body);
    answer_.prepare_payload();
    http::async_write(
        socket_, answer_,
        [self = shared_from_this()](const error_code&, std::size_t) { self->Close(); });
  }

  void Close() {
    deadline_.cancel();
    error_code ignored;  // It may be gone already.
    socket_.shutdown(Socket::shutdown_both, ignored);
    socket_.close(ignored);
  }

  Socket socket_;
  timer::Timer deadline_;
  std::shared_ptr<Desk> desk_;
  boost::beast::flat_static_buffer<kMostHeaderBytes> buffer_;
  http::request_parser<http::empty_body> parser_;
  http::response<http::string_body> answer_;
};

}  // namespace

class MetricsEndpoint::Implementation {
 public:
  explicit Implementation(std::function<std::string()> text) : desk_(std::make_shared<Desk>()) {
    desk_->text = std::move(text);
  }
  ~Implementation() {
    desk_->closed = true;  // `text` may be called no more.
    desk_->text = nullptr;
  }

  Result<void> Listen(boost::asio::io_context& io, const transport::Address& address) {
    transport::ListenSecurity security;
    security.passed_in_clear = true;
    auto listener = transport::Listener::Open(
        io, address,
        [desk = desk_](transport::Socket socket) {
          if (desk->connections < kMostConnections) {
            std::make_shared<Exchange>(std::move(socket.plain()), desk)->Start();
          }
        },
        security);
    if (!listener) return listener.error();
    listener_ = std::move(*listener);
    return {};
  }

  const transport::Address& address() const { return listener_->address(); }

 private:
  std::shared_ptr<Desk> desk_;
  std::unique_ptr<transport::Listener> listener_;
};

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
  auto implementation = std::make_unique<Implementation>(std::move(text));
  const auto parsed = transport::ParseAddress(address);
  if (const auto listening = implementation->Listen(io, *parsed); !listening) {
    return listening.error();
  }
  return std::unique_ptr<MetricsEndpoint>(new MetricsEndpoint(std::move(implementation)));
}

MetricsEndpoint::MetricsEndpoint(std::unique_ptr<Implementation> implementation)
    : implementation_(std::move(implementation)) {}
MetricsEndpoint::~MetricsEndpoint() = default;
const transport::Address& MetricsEndpoint::address() const { return implementation_->address(); }

}  // namespace footing::monitoring
