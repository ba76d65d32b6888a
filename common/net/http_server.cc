#include "common/net/http_server.h"

#include <optional>
#include <type_traits>

#include <boost/beast/core/flat_static_buffer.hpp>
#include <boost/beast/http.hpp>

#include "common/net/metrics_endpoint.h"
#include "common/runtime/timer.h"

namespace footing::http_server {

namespace http = boost::beast::http;
using boost::system::error_code;

/// State that the connections share.
struct Server::Desk {
  Options options;
  int connections = 0;
  bool closed = false;
};

namespace {

constexpr const char* kPlainText = "text/plain; charset=utf-8";

/// One connection: requests and answers, one after the other.
class Exchange : public std::enable_shared_from_this<Exchange> {
 public:
  Exchange(transport::Socket socket, std::shared_ptr<Server::Desk> desk)
      : stream_(std::move(socket)),
        deadline_(stream_.get_executor()),
        desk_(std::move(desk)),
        place_(nullptr, [desk = desk_](void*) { --desk->connections; }) {
    ++desk_->connections;
    transport::Prepare(stream_.socket());
  }

  void Start() {
    deadline_.After(desk_->options.request_within, [this] { Close(); });
    if (!stream_.socket().needs_handshake()) return Read();
    stream_.socket().AsyncHandshake(
        [](const std::function<void()>& step) { step(); },
        [self = shared_from_this()](tls::Progress progress) { self->OnHandshake(progress); });
  }

 private:
  void OnHandshake(tls::Progress progress) {
    if (desk_->closed) return;
    if (progress == tls::Progress::kDone) return Read();
    if (progress != tls::Progress::kNotTls) return Close();
    stream_.socket().GoOnInClear();
    Send(text_, {http::status::bad_request, kPlainText, "this port speaks TLS: use https://\n"},
         10);
  }

  void Read() {
    parser_.emplace();
    parser_->header_limit(static_cast<std::uint32_t>(desk_->options.most_header_bytes));
    parser_->body_limit(desk_->options.most_body_bytes);
    http::async_read(
        stream_, buffer_, *parser_,
        [self = shared_from_this()](const error_code& error, std::size_t) { self->OnRead(error); });
  }

  void OnRead(const error_code& error) {
    if (desk_->closed || error == boost::asio::error::operation_aborted) return;
    if (error == http::error::end_of_stream || !stream_.socket().plain().is_open()) return;
    const Request* const request = error ? nullptr : &parser_->get();
    const Options& options = desk_->options;
    if (request != nullptr && options.upgrade && options.upgrade(*request, stream_, place_)) {
      return deadline_.cancel();
    }
    Answer answer = options.answer(request);
    const unsigned version = request == nullptr ? 10 : request->version();
    stays_ = request != nullptr && request->keep_alive() && options.next_within.count() > 0 &&
             request->method() != http::verb::head;
    if (!answer.file.empty()) {
      error_code failed;
      file_ = {};
      file_.body().open(answer.file.c_str(), boost::beast::file_mode::scan, failed);
      if (!failed) return Send(file_, answer, version);
      answer = {http::status::not_found, kPlainText, "it cannot be read\n"};
    }
    Send(text_, answer, version);
  }

  template <typename Response>
  void Send(Response& response, const Answer& answer, unsigned version) {
    if constexpr (std::is_same_v<Response, http::response<http::string_body>>) {
      response = {};
      response.body() = answer.text;
    }
    response.result(answer.status);
    response.version(version);
    response.keep_alive(stays_);
    if (!answer.type.empty()) response.set(http::field::content_type, answer.type);
    if (answer.status == http::status::method_not_allowed) {
      response.set(http::field::allow, "GET");
    }
    for (const auto& [name, value] : desk_->options.headers) response.set(name, value);
    for (const auto& [name, value] : answer.headers) response.set(name, value);
    response.prepare_payload();
    deadline_.After(answer.file.empty() ? desk_->options.answer_within : desk_->options.file_within,
                    [this] { Close(); });
    http::async_write(
        stream_, response,
        [self = shared_from_this()](const error_code& error, std::size_t) { self->OnSent(error); });
  }

  void OnSent(const error_code& error) {
    if (error || !stays_ || desk_->closed) return Close();
    deadline_.After(desk_->options.next_within, [this] { Close(); });
    Read();
  }

  void Close() {
    deadline_.cancel();
    stream_.socket().SayNoMore();
    stream_.socket().Close();
  }

  Stream stream_;
  timer::Timer deadline_;
  std::shared_ptr<Server::Desk> desk_;
  Place place_;
  bool stays_ = false;  ///< Another request may follow.
  boost::beast::flat_static_buffer<kMostHeaderBytes> buffer_;
  std::optional<http::request_parser<http::string_body>> parser_;
  http::response<http::string_body> text_;
  http::response<http::file_body> file_;
};

}  // namespace

Result<std::unique_ptr<Server>> Server::Open(boost::asio::io_context& io,
                                             const transport::Address& address, Options options,
                                             const transport::ListenSecurity& security) {
  auto desk = std::make_shared<Desk>();
  desk->options = std::move(options);
  auto listener = transport::Listener::Open(
      io, address,
      [desk](transport::Socket socket) {
        if (desk->connections < desk->options.most_connections)
          std::make_shared<Exchange>(std::move(socket), desk)->Start();
      },
      security);
  if (!listener) return listener.error();
  return std::unique_ptr<Server>(new Server(std::move(desk), std::move(*listener)));
}

Server::Server(std::shared_ptr<Desk> desk, std::unique_ptr<transport::Listener> listener)
    : desk_(std::move(desk)), listener_(std::move(listener)) {}

Server::~Server() {
  desk_->closed = true;
  desk_->options = {};
}

}  // namespace footing::http_server

// The page of metrics, in this file so that Beast is parsed once.
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
      {.answer = [text = std::move(text)](
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
