#include "clients/skeleton/web_server.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <map>
#include <utility>

#include <boost/beast/core/flat_static_buffer.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <nlohmann/json.hpp>

#include "common/net/http_server.h"

namespace footing::skeleton {
namespace {

namespace http = boost::beast::http;
namespace websocket = boost::beast::websocket;
using boost::system::error_code;
using http_server::Answer;
using http_server::Request;
using http_server::Stream;

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

constexpr std::string_view kModelPrefix = "/pose/";

}  // namespace

/// State shared by the pages.
struct WebServer::Desk {
  WebOptions options;
  WebCounts counts;
  std::string state;
  bool closed = false;
};

namespace {

/// A page's own address, as its requests name it.
bool IsOwnOrigin(const Request& request) {
  const std::string host(request[http::field::host]);
  return !host.empty() && request[http::field::origin] == "http://" + host;
}

/// The WebSocket of one page.
class PageSession : public std::enable_shared_from_this<PageSession> {
 public:
  PageSession(Stream stream, std::shared_ptr<WebServer::Desk> desk, http_server::Place place)
      : stream_(std::move(stream)), desk_(std::move(desk)), place_(std::move(place)) {}

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

  websocket::stream<Stream> stream_;
  std::shared_ptr<WebServer::Desk> desk_;
  const http_server::Place place_;
  boost::beast::flat_static_buffer<kMostMessageBytes> buffer_;
};

Answer Refuse(WebServer::Desk& desk, http::status status, const std::string& text) {
  ++desk.counts.refused;
  return {status, "text/plain; charset=utf-8", text};
}

bool WantsSocket(const Request& request) {
  return IsOwnHost(request[http::field::host]) && websocket::is_upgrade(request) &&
         request.target() == "/skeleton";
}

Answer AnswerTo(const Request* request, WebServer::Desk& desk) {
  if (request == nullptr) return Refuse(desk, http::status::bad_request, "this is not a request\n");
  if (!IsOwnHost((*request)[http::field::host]))
    return Refuse(desk, http::status::forbidden, "another host's name\n");
  if (WantsSocket(*request))
    return Refuse(desk, http::status::forbidden, "pages of other origins are refused\n");
  if (request->method() != http::verb::get && request->method() != http::verb::head)
    return Refuse(desk, http::status::method_not_allowed, "there is GET\n");
  std::string_view target = request->target();
  target = target.substr(0, target.find('?'));
  if (target.starts_with(kModelPrefix)) {
    const auto path = ModelFile(desk.options.package, target.substr(kModelPrefix.size()));
    if (!path)
      return Refuse(desk, http::status::not_found,
                    "@mediapipe/pose has no such file; run scripts/fetch-pose-model\n");
    const auto type = kTypes.find(path->extension().native());
    return {.type = type == kTypes.end() ? "application/octet-stream" : type->second,
            .file = *path};
  }
  if (const PageFile* file = target.starts_with('/') ? FindPageFile(target.substr(1)) : nullptr)
    return {.type = std::string(file->type), .text = std::string(file->text)};
  return Refuse(desk, http::status::not_found, "this page does not exist\n");
}

}  // namespace

Result<std::unique_ptr<WebServer>> WebServer::Open(boost::asio::io_context& io,
                                                   WebOptions options) {
  if (options.listen.kind != transport::Address::Kind::kTcp)
    return UsageError("--web " + options.listen.Text() + ": must be 127.0.0.1:PORT");
  auto desk = std::make_shared<Desk>();
  desk->options = std::move(options);
  auto server = http_server::Server::Open(
      io, desk->options.listen,
      {.most_connections = 16,
       .most_header_bytes = http_server::kMostHeaderBytes,
       .answer_within = std::chrono::seconds(60),  // 28 MB of a model.
       .headers = {{"Cache-Control", "no-cache"},
                   {"X-Content-Type-Options", "nosniff"},
                   {"Content-Security-Policy", kPolicy}},
       .answer = [desk](const Request* request) { return AnswerTo(request, *desk); },
       .upgrade =
           [desk](const Request& request, Stream& stream, const http_server::Place& place) {
             if (!WantsSocket(request) || !IsOwnOrigin(request)) return false;
             std::make_shared<PageSession>(std::move(stream), desk, place)->Start(request);
             return true;
           }});
  if (!server) return server.error();
  return std::unique_ptr<WebServer>(new WebServer(std::move(desk), std::move(*server)));
}

WebServer::WebServer(std::shared_ptr<Desk> desk, std::unique_ptr<http_server::Server> server)
    : desk_(std::move(desk)), server_(std::move(server)) {}

WebServer::~WebServer() {
  desk_->closed = true;  // The functions may be called no more.
  desk_->options.on_packet = nullptr;
  desk_->options.on_state = nullptr;
}

const WebCounts& WebServer::counts() const { return desk_->counts; }
const transport::Address& WebServer::address() const { return server_->address(); }

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
