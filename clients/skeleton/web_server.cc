#include "clients/skeleton/web_server.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <map>
#include <utility>

#include <boost/beast/core/flat_static_buffer.hpp>
#include <boost/beast/core/multi_buffer.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <nlohmann/json.hpp>

#include "common/net/listener.h"
#include "common/net/socket.h"
#include "common/runtime/timer.h"

namespace footing::skeleton {
namespace {

namespace http = boost::beast::http;
namespace websocket = boost::beast::websocket;
using boost::system::error_code;
using Socket = transport::PlainSocket;
using Request = http::request<http::empty_body>;

constexpr int kMostConnections = 16;
constexpr auto kLongestRequest = std::chrono::seconds(5);
constexpr auto kLongestAnswer = std::chrono::seconds(60);  // 28 MB of a model.
constexpr std::size_t kMostHeaderBytes = 8192;
constexpr std::size_t kMostMessageBytes = osc::kMostPacketBytes;
constexpr std::size_t kMostStateBytes = 200;
/// Nothing comes from another host. The model's own code makes functions out of text and compiles
/// WebAssembly.
constexpr const char* kPolicy =
    "default-src 'self' data: blob:; script-src 'self' 'unsafe-eval' blob:; worker-src 'self' "
    "blob:; "
    "connect-src 'self' ws: data: blob:";

const std::map<std::string_view, const char*> kTypes = {
    {".js", "text/javascript"},
    {".wasm", "application/wasm"},
};

/// State shared by the connections.
struct Desk {
  WebOptions options;
  WebCounts counts;
  std::string state;
  int connections = 0;
  bool closed = false;
};

constexpr std::string_view kModelPrefix = "/pose/";

/// A page's own address, as its requests name it.
bool IsOwnOrigin(const Request& request) {
  const std::string host(request[http::field::host]);
  return !host.empty() && request[http::field::origin] == "http://" + host;
}

/// The WebSocket of one page.
class PageSession : public std::enable_shared_from_this<PageSession> {
 public:
  PageSession(Socket socket, std::shared_ptr<Desk> desk)
      : stream_(std::move(socket)), desk_(std::move(desk)) {
    ++desk_->connections;
  }
  ~PageSession() { --desk_->connections; }

  void Start(const Request& request) {
    stream_.set_option(websocket::stream_base::timeout::suggested(boost::beast::role_type::server));
    stream_.read_message_max(kMostMessageBytes);
    stream_.async_accept(request, [self = shared_from_this()](const error_code& error) {
      if (error) return;
      ++self->desk_->counts.pages;
      self->ReadLater();
    });
  }

 private:
  void ReadLater() {
    stream_.async_read(buffer_, [self = shared_from_this()](const error_code& error, std::size_t) {
      if (error || self->desk_->closed) return;
      self->Take();
      self->buffer_.consume(self->buffer_.size());
      self->ReadLater();
    });
  }

  void Take() {
    const auto bytes = buffer_.cdata();
    const auto* const first = static_cast<const std::uint8_t*>(bytes.data());
    if (stream_.got_binary()) {
      ++desk_->counts.packets;
      desk_->options.on_packet({first, bytes.size()});
      return;
    }
    const auto report = nlohmann::json::parse(first, first + bytes.size(), nullptr, false);
    if (!report.is_object() || !report.contains("frames") ||
        !report["frames"].is_number_unsigned() || !report.contains("found") ||
        !report["found"].is_number_unsigned()) {
      ++desk_->counts.refused;
      return;
    }
    desk_->counts.frames = report["frames"].get<std::uint64_t>();
    desk_->counts.found = report["found"].get<std::uint64_t>();
    if (report.contains("state") && report["state"].is_string())
      TakeState(report["state"].get<std::string>());
  }

  void TakeState(std::string state) {
    state.resize(std::min(state.size(), kMostStateBytes));
    std::replace_if(
        state.begin(), state.end(), [](char c) { return c < ' ' || c > '~'; }, ' ');
    if (state == desk_->state) return;
    desk_->state = state;
    if (desk_->options.on_state) desk_->options.on_state(state);
  }

  websocket::stream<Socket> stream_;
  std::shared_ptr<Desk> desk_;
  boost::beast::flat_static_buffer<kMostMessageBytes> buffer_;
};

/// One connection: a request, and a file or a WebSocket.
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
    Expire(kLongestRequest);
    http::async_read(
        socket_, buffer_, parser_,
        [self = shared_from_this()](const error_code& error, std::size_t) { self->OnRead(error); });
  }

 private:
  void Expire(std::chrono::seconds after) {
    deadline_.expires_after(after);
    deadline_.async_wait([weak = weak_from_this()](const error_code& error) {
      const auto self = weak.lock();
      if (!error && self) self->Close();
    });
  }

  void OnRead(const error_code& error) {
    if (desk_->closed || error == boost::asio::error::operation_aborted) return;
    if (error == http::error::end_of_stream || !socket_.is_open()) return;
    if (error) return Refuse(http::status::bad_request, "this is not a request\n");
    const Request& request = parser_.get();
    if (!IsOwnHost(request[http::field::host]))
      return Refuse(http::status::forbidden, "another host's name\n");
    if (websocket::is_upgrade(request) && request.target() == "/skeleton") return Upgrade(request);
    if (request.method() != http::verb::get && request.method() != http::verb::head)
      return Refuse(http::status::method_not_allowed, "there is GET\n");
    std::string_view target = request.target();
    target = target.substr(0, target.find('?'));
    if (target.starts_with(kModelPrefix)) return AnswerModelFile(target);
    if (const PageFile* file = target.starts_with('/') ? FindPageFile(target.substr(1)) : nullptr) {
      Prepare(text_, http::status::ok, file->type);
      text_.body() = file->text;
      return Send(text_);
    }
    Refuse(http::status::not_found, "this page does not exist\n");
  }

  void Upgrade(const Request& request) {
    if (!IsOwnOrigin(request))
      return Refuse(http::status::forbidden, "pages of other origins are refused\n");
    deadline_.cancel();
    std::make_shared<PageSession>(std::move(socket_), desk_)->Start(request);
  }

  void AnswerModelFile(std::string_view target) {
    const auto path = ModelFile(desk_->options.package, target.substr(kModelPrefix.size()));
    error_code error;
    if (path) file_.body().open(path->c_str(), boost::beast::file_mode::scan, error);
    if (!path || error)
      return Refuse(http::status::not_found,
                    "@mediapipe/pose has no such file; run scripts/fetch-pose-model\n");
    const auto type = kTypes.find(path->extension().native());
    Prepare(file_, http::status::ok,
            type == kTypes.end() ? "application/octet-stream" : type->second);
    Send(file_);
  }

  void Refuse(http::status status, std::string_view text) {
    ++desk_->counts.refused;
    Prepare(text_, status, "text/plain; charset=utf-8");
    text_.body() = text;
    Send(text_);
  }

  template <typename Answer>
  void Prepare(Answer& answer, http::status status, std::string_view type) {
    answer.result(status);
    answer.version(11);
    answer.keep_alive(false);
    answer.set(http::field::content_type, type);
    answer.set(http::field::cache_control, "no-cache");
    answer.set("X-Content-Type-Options", "nosniff");
    answer.set("Content-Security-Policy", kPolicy);
  }

  template <typename Answer>
  void Send(Answer& answer) {
    answer.prepare_payload();
    Expire(kLongestAnswer);
    http::async_write(socket_, answer, [self = shared_from_this()](const error_code&, std::size_t) {
      self->Close();
    });
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
  http::response<http::string_body> text_;
  http::response<http::file_body> file_;
};

}  // namespace

class WebServer::Implementation {
 public:
  explicit Implementation(WebOptions options) : desk_(std::make_shared<Desk>()) {
    desk_->options = std::move(options);
  }
  ~Implementation() {
    desk_->closed = true;  // The functions may be called no more.
    desk_->options.on_packet = nullptr;
    desk_->options.on_state = nullptr;
  }

  Result<void> Listen(boost::asio::io_context& io) {
    if (desk_->options.listen.kind != transport::Address::Kind::kTcp)
      return UsageError("--web " + desk_->options.listen.Text() + ": must be 127.0.0.1:PORT");
    auto listener = transport::Listener::Open(
        io, desk_->options.listen, [desk = desk_](transport::Socket socket) {
          if (desk->connections < kMostConnections)
            std::make_shared<Exchange>(std::move(socket.plain()), desk)->Start();
        });
    if (!listener) return listener.error();
    listener_ = std::move(*listener);
    return {};
  }

  const WebCounts& counts() const { return desk_->counts; }
  const transport::Address& address() const { return listener_->address(); }

 private:
  std::shared_ptr<Desk> desk_;
  std::unique_ptr<transport::Listener> listener_;
};

Result<std::unique_ptr<WebServer>> WebServer::Open(boost::asio::io_context& io,
                                                   WebOptions options) {
  auto implementation = std::make_unique<Implementation>(std::move(options));
  if (const auto listening = implementation->Listen(io); !listening) return listening.error();
  return std::unique_ptr<WebServer>(new WebServer(std::move(implementation)));
}

WebServer::WebServer(std::unique_ptr<Implementation> implementation)
    : implementation_(std::move(implementation)) {}
WebServer::~WebServer() = default;

const WebCounts& WebServer::counts() const { return implementation_->counts(); }
const transport::Address& WebServer::address() const { return implementation_->address(); }

std::filesystem::path DefaultPosePackage() {
  const char* const data = std::getenv("XDG_DATA_HOME");
  const char* const home = std::getenv("HOME");
  const std::filesystem::path base =
      data != nullptr && *data != '\0'
          ? std::filesystem::path(data)
          : std::filesystem::path(home != nullptr ? home : "/") / ".local/share";
  return base / "footing/mediapipe-pose";
}

std::optional<std::filesystem::path> ModelFile(const std::filesystem::path& package,
                                               std::string_view name) {
  const auto is_plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '.' || c == '-';
  };
  if (name.empty() || name[0] == '.' || !std::all_of(name.begin(), name.end(), is_plain))
    return std::nullopt;
  const std::filesystem::path path = package / name;
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return std::nullopt;
  return path;
}

bool IsOwnHost(std::string_view host) {
  const std::string_view name = host.substr(0, host.rfind(':'));
  return name == "127.0.0.1" || name == "localhost" || name == "[::1]";
}

}  // namespace footing::skeleton
