#include "clients/web/web_server.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <map>
#include <random>
#include <span>
#include <utility>

#include <sys/stat.h>

#include <boost/asio/ip/udp.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <nlohmann/json.hpp>

#include "clients/web/foxglove_feed.h"
#include "common/base/osc.h"
#include "common/base/text.h"
#include "common/base/units.h"
#include "common/cli/cli.h"
#include "common/net/access.h"
#include "common/net/client.h"
#include "common/net/framing.h"
#include "common/net/http_server.h"
#include "common/net/known_servers.h"
#include "common/net/own_address.h"
#include "common/net/tls_context.h"
#include "common/runtime/clock.h"
#include "common/runtime/files.h"
#include "common/runtime/log.h"
#include "common/runtime/timer.h"
#include "common/stream/product_ids.h"
#include "footing/v1/session.pb.h"

namespace footing::web {
namespace {

namespace asio = boost::asio;
namespace http = boost::beast::http;
namespace websocket = boost::beast::websocket;
using boost::system::error_code;
using http_server::Answer;
using http_server::Request;
using http_server::Stream;

constexpr int kMostConnections = 512;
/// Longest body of a request: reports of a phone that sends them by POST.
constexpr std::size_t kMostBodyBytes = 8 << 10;
/// A page that neither reads nor answers is dropped.
constexpr auto kIdle = std::chrono::seconds(20);
/// A few ticks: more would be old when they reach a slow page.
constexpr int kSendBufferBytes = 32 << 10;
constexpr const char* kCookie = "footing_pass";
constexpr const char* kText = "text/plain; charset=utf-8";
/// Nothing comes from another host, and nothing runs but the files of these pages.
constexpr const char* kPolicy =
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data:; "
    "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";
constexpr const char* kPermissions = "accelerometer=(self), gyroscope=(self), camera=()";
/// For the page with the pose model, whose own code makes functions out of text and compiles
/// WebAssembly.
constexpr const char* kWebcamPolicy =
    "default-src 'self' data: blob:; script-src 'self' 'unsafe-eval' blob:; worker-src 'self' "
    "blob:; connect-src 'self' data: blob:; base-uri 'none'; form-action 'none'; frame-ancestors "
    "'none'";
constexpr const char* kWebcamPermissions = "camera=(self)";
constexpr std::string_view kModelPrefix = "/pose/";
constexpr std::int64_t kSkeletonsLostNs = 1'000'000'000;

/// Beside the identity of tls:, keeps the passes.
constexpr const char* kPassesFile = "web_passes";
constexpr std::size_t kMostPassesBytes = 64 << 10;

/// Letters and digits that nobody mistakes for each other, 100 bits.
std::string Secret() {
  constexpr std::string_view kLetters = "abcdefghijkmnpqrstuvwxyz23456789";
  static_assert(kLetters.size() == 32);
  std::random_device random;
  std::string secret;
  for (int i = 0; i < 20; ++i) secret += kLetters[random() % kLetters.size()];
  return secret;
}

}  // namespace

class Mailbox;

/// State that all connections share.
struct WebServer::Desk {
  Desk(asio::io_context& own_io, WebOptions own_options)
      : io(own_io), options(std::move(own_options)) {}

  asio::io_context& io;
  WebOptions options;
  WebCounts counts;
  Passes passes{Secret};
  std::string passes_file;               ///< Keeps them for the next start; empty: nothing does.
  const std::string session = Secret();  ///< Name of this start of the program, for Foxglove.
  std::string refused_foxglove;          ///< Why the last one was, which is logged once.
  std::map<std::string, std::shared_ptr<Mailbox>> mailboxes;  ///< By the phone's pass.
  std::optional<tls::Identity> identity;
  timer::Timer certificate_check{io};
  transport::TokenGuard token{options.token};
  std::vector<std::unique_ptr<http_server::Server>> servers;
  bool closed = false;
};

namespace {

using Desk = WebServer::Desk;

/// Takes the passes of the last start, so that its pages go on without a new code.
void FindPasses(Desk& desk) {
  const auto file = config::RegularFile::Open(desk.passes_file);
  if (!file) return;  // The first start.
  if (file->Allows(S_IRWXG | S_IRWXO)) {
    log::Warning(desk.passes_file + ": others may read or change it, so its passes do not count; " +
                 "chmod 600 it, or delete it");
    return;
  }
  const auto text = file->Read(kMostPassesBytes);
  if (text) desk.passes.Take(*text, clock::MonotonicNs(), clock::WallNs());
}

void KeepPasses(Desk& desk) {
  if (desk.passes_file.empty()) return;
  const auto kept = config::ReplaceFile(desk.passes_file,
                                        desk.passes.Text(clock::MonotonicNs(), clock::WallNs()));
  if (kept) return;
  log::Warning("cannot keep the pages' passes: " + desk.passes_file + ": " + kept.error().message +
               "; after a restart each page needs a new code");
  desk.passes_file.clear();
}

/// A phone's message, checked: it attaches an inertial sensor and sends its reports, and nothing
/// else. The first one of a connection must attach.
Result<void> CheckDevice(std::string_view message, bool first) {
  v1::DeviceEnvelope envelope;
  if (!envelope.ParseFromArray(message.data(), static_cast<int>(message.size()))) {
    return InvalidData("a message is not a DeviceEnvelope");
  }
  if (!envelope.has_attach() && !envelope.has_input_report() && !envelope.has_detach()) {
    return InvalidData("a page may attach an inertial sensor, send its reports and detach it");
  }
  if (first && !envelope.has_attach()) {
    return InvalidData("the connection to footingd is new: attach the sensor again");
  }
  const v1::DeviceAttach& attach = envelope.attach();
  if (envelope.has_attach() && !stream::IsInertialSensor(attach.vendor(), attach.product())) {
    return InvalidData("a page may attach an inertial sensor only");
  }
  return {};
}

}  // namespace

/// The devices of a browser that cannot open a WebSocket: each request brings some messages, and
/// takes those that footingd has sent since. Without a request for kAwayS the devices are gone.
class Mailbox : public std::enable_shared_from_this<Mailbox> {
 public:
  static constexpr double kAwayS = 5;

  Mailbox(asio::io_context& io, transport::Address address)
      : io_(io), address_(std::move(address)), away_(io) {}

  void Start() {
    transport::Dial(io_, address_, [self = shared_from_this()](Result<transport::Socket> dialled) {
      if (!dialled) {
        self->over_ = dialled.error().message;
        return;
      }
      transport::FramedLimits limits;
      limits.max_in_bytes = limits.max_out_bytes = transport::kMaxDeviceBytes;
      limits.max_queued_bytes = kMostBodyBytes;
      transport::FramedHandlers handlers;
      handlers.on_frame = [mailbox = self.get()](std::string_view payload) {
        if (mailbox->answer_.size() < kMostBodyBytes) mailbox->answer_ += transport::Frame(payload);
      };
      handlers.on_close = [mailbox = self.get()](const std::string& why) { mailbox->over_ = why; };
      self->server_ = std::make_unique<transport::FramedConnection>(std::move(dialled).value(),
                                                                    limits, std::move(handlers));
      self->server_->Start();
      for (const std::string& message : std::exchange(self->early_, {}))
        self->server_->Send(message);
    });
  }

  /// Frames of DeviceEnvelopes; those of footingd since the last time.
  Result<std::string> Take(std::string_view body) {
    std::vector<std::string> messages;
    Result<void> checked = {};
    const auto fed = transport::FrameSplitter(transport::kMaxDeviceBytes)
                         .Feed(body, [&](std::string_view message) {
                           checked = CheckDevice(message, !std::exchange(begun_, true));
                           messages.emplace_back(message);
                           return checked.ok();
                         });
    if (!fed) return fed.error();
    if (!checked) return checked.error();
    if (!over_.empty() && answer_.empty()) return Failure(over_);
    if (server_) {
      for (const std::string& message : messages) server_->Send(message);
    } else if (early_.size() < kMostEarly) {
      early_.insert(early_.end(), messages.begin(), messages.end());
    }
    return std::exchange(answer_, {});
  }

  bool over() const { return !over_.empty() && answer_.empty(); }
  timer::Timer& away() { return away_; }

 private:
  static constexpr std::size_t kMostEarly = 64;  ///< Messages, until footingd has answered.

  asio::io_context& io_;
  const transport::Address address_;
  timer::Timer away_;
  std::unique_ptr<transport::FramedConnection> server_;
  std::vector<std::string> early_;
  bool begun_ = false;
  std::string answer_;
  std::string over_;  ///< Why there is no connection any more.
};

namespace {

/// The kind of messages on a WebSocket.
enum class Carries { kSession, kDevices, kSurvey };

constexpr std::size_t MostBytes(Carries carries) {
  switch (carries) {
    case Carries::kSession:
      return 64u << 10;
    case Carries::kDevices:
      return transport::kMaxDeviceBytes;
    case Carries::kSurvey:
      return 16u << 10;
  }
  return 0;
}

/// One WebSocket and its connection to a server. Messages go one by one: the next one is read when
/// the one before it has left, so nothing is queued here, and the server sees how fast the page
/// reads.
class Bridge : public std::enable_shared_from_this<Bridge> {
 public:
  Bridge(Stream stream, std::shared_ptr<Desk> desk, http_server::Place place,
         transport::Address address, Carries carries)
      : page_(std::move(stream)),
        desk_(std::move(desk)),
        place_(std::move(place)),
        address_(std::move(address)),
        carries_(carries) {}

  void Start(const Request& request) {
    error_code ignored;
    page_.next_layer().socket().plain().set_option(
        asio::socket_base::send_buffer_size(kSendBufferBytes), ignored);
    websocket::stream_base::timeout timeout{std::chrono::seconds(5), kIdle, true};
    page_.set_option(timeout);
    page_.read_message_max(MostBytes(carries_));
    page_.binary(true);
    page_.async_accept(request, [self = shared_from_this()](const error_code& error) {
      if (error || self->desk_->closed) return;
      ++self->desk_->counts.connections;
      self->DialServer();
      self->ReadPage();
    });
  }

 private:
  void DialServer() {
    transport::Dial(desk_->io, address_,
                    [self = shared_from_this()](Result<transport::Socket> dialled) {
                      self->OnDialled(std::move(dialled));
                    });
  }

  void OnDialled(Result<transport::Socket> dialled) {
    if (over_ || desk_->closed) return;
    if (!dialled) return End(websocket::close_code::try_again_later, dialled.error().message);
    server_ = std::make_unique<transport::Socket>(std::move(dialled).value());
    transport::Prepare(*server_);
    if (!server_->needs_handshake()) return OnConnected();
    server_->AsyncHandshake([](const std::function<void()>& step) { step(); },
                            [self = shared_from_this()](tls::Progress progress) {
                              if (self->over_) return;
                              if (progress == tls::Progress::kDone) return self->OnConnected();
                              self->End(websocket::close_code::try_again_later,
                                        self->server_->channel().problem());
                            });
  }

  void OnConnected() {
    connected_ = true;
    ReadServer();
    if (!to_server_.empty()) WriteServer(0);
  }

  // From the page to the server.

  void ReadPage() {
    page_.async_read(from_page_, [self = shared_from_this()](const error_code& error, std::size_t) {
      if (self->over_) return;
      if (error || self->desk_->closed) return self->Drop();
      self->OnPageMessage();
    });
  }

  void OnPageMessage() {
    const std::string_view message(static_cast<const char*>(from_page_.data().data()),
                                   from_page_.size());
    const auto checked = Checked(message);
    from_page_.consume(from_page_.size());
    if (!checked) {
      const double wait_s = guesses_ ? transport::ServerOptions().wrong_token_wait_s : 0;
      return answer_.After(wait_s,
                           [this, why = checked.error().message, self = shared_from_this()] {
                             End(websocket::close_code::policy_error, why);
                           });
    }
    said_hello_ = true;
    to_server_ = transport::Frame(*checked);
    if (connected_) WriteServer(0);
  }

  /// The page's message as it goes to the server.
  Result<std::string> Checked(std::string_view message) {
    if (carries_ == Carries::kSession && !said_hello_) return CheckHello(message);
    if (carries_ == Carries::kDevices) {
      if (const auto checked = CheckDevice(message, !said_hello_); !checked) return checked.error();
    }
    return std::string(message);
  }

  /// The page's first message, with a role that its token permits.
  Result<std::string> CheckHello(std::string_view message) {
    v1::Envelope envelope;
    if (!envelope.ParseFromArray(message.data(), static_cast<int>(message.size())) ||
        !envelope.has_hello()) {
      return InvalidData("the first message of a page must be a Hello");
    }
    v1::Hello& hello = *envelope.mutable_hello();
    const bool has_token = !hello.token().empty();
    const std::string host = transport::PeerOf(page_.next_layer().socket().native_handle()).host;
    const auto verdict = has_token ? desk_->token.Check(hello.token(), host, clock::MonotonicNs())
                                   : transport::TokenGuard::Verdict{};
    if (has_token && verdict.role != v1::ROLE_CONTROL) {
      guesses_ = verdict.waits;
      return InvalidData("the token is wrong; use that of the token file of footing-web");
    }
    transport::ClientOptions own;
    own.address = address_;
    own.client_name = "web: " + hello.client_name().substr(0, 60);
    own.role = has_token && hello.role() == v1::ROLE_CONTROL ? v1::ROLE_CONTROL : v1::ROLE_VIEW;
    const auto made = transport::MakeHello(own);
    if (!made) return made.error();
    return made->SerializeAsString();
  }

  void WriteServer(std::size_t written) {
    error_code error;
    const asio::const_buffer rest = asio::buffer(to_server_) + written;
    written += server_->WriteSome(std::span(&rest, 1), error);
    if (error && error != asio::error::would_block) return EndOfServer(error);
    if (written == to_server_.size()) {
      to_server_.clear();
      return ReadPage();
    }
    server_->AsyncWait(tls::Progress::kWantsWrite,
                       [self = shared_from_this(), written](const error_code& failed) {
                         if (!failed && !self->over_) self->WriteServer(written);
                       });
  }

  // From the server to the page.

  void ReadServer() {
    server_->AsyncReadSome(asio::buffer(input_),
                           [self = shared_from_this()](const error_code& error, std::size_t size) {
                             if (self->over_) return;
                             if (error) return self->EndOfServer(error);
                             self->unhandled_ = std::string_view(self->input_.data(), size);
                             self->NextFrame();
                           });
  }

  void NextFrame() {
    bool whole = false;
    const auto fed = splitter_.Feed(unhandled_, [&](std::string_view payload) {
      to_page_.assign(payload);
      whole = true;
      return false;
    });
    if (!fed) return End(websocket::close_code::internal_error, fed.error().message);
    unhandled_.remove_prefix(*fed);
    if (!whole) return ReadServer();
    page_.async_write(asio::buffer(to_page_),
                      [self = shared_from_this()](const error_code& error, std::size_t) {
                        if (self->over_) return;
                        if (error || self->desk_->closed) return self->Drop();
                        self->NextFrame();
                      });
  }

  // The end.

  void EndOfServer(const error_code& error) {
    End(websocket::close_code::going_away,
        transport::CloseReason(error, splitter_.pending_bytes() > 0));
  }

  void End(websocket::close_code code, const std::string& why) {
    if (over_) return;
    over_ = true;
    if (server_) server_->Close();
    websocket::close_reason reason(code);
    reason.reason = why.substr(0, 120);  // A control frame has at most 125 bytes.
    page_.async_close(reason, [self = shared_from_this()](const error_code&) {});
  }

  void Drop() {
    over_ = true;
    if (server_) server_->Close();
    page_.next_layer().socket().Close();
  }

  websocket::stream<Stream> page_;
  std::shared_ptr<Desk> desk_;
  const http_server::Place place_;
  const transport::Address address_;
  const Carries carries_;
  std::unique_ptr<transport::Socket> server_;
  transport::FrameSplitter splitter_{1u << 20};
  boost::beast::flat_buffer from_page_;
  std::string to_server_, to_page_;
  std::array<char, 16 << 10> input_;
  std::string_view unhandled_;  ///< The part of input_ that has not gone to the page yet.
  timer::Timer answer_{desk_->io};
  bool connected_ = false;
  bool said_hello_ = false;
  bool guesses_ = false;  ///< Its token was wrong once too often: the answer waits.
  bool over_ = false;
};

/// A program that draws with Foxglove's protocol, and a session with each server for it.
class FoxgloveSocket : public std::enable_shared_from_this<FoxgloveSocket> {
 public:
  FoxgloveSocket(Stream stream, std::shared_ptr<Desk> desk, http_server::Place place)
      : page_(std::move(stream)),
        desk_(std::move(desk)),
        place_(std::move(place)),
        feed_(desk_->session) {}

  void Start(const Request& request, std::string_view protocol) {
    error_code ignored;
    page_.next_layer().socket().plain().set_option(
        asio::socket_base::send_buffer_size(kSendBufferBytes), ignored);
    page_.set_option(websocket::stream_base::timeout{std::chrono::seconds(5), kIdle, true});
    page_.read_message_max(64u << 10);
    page_.set_option(
        websocket::stream_base::decorator([protocol](websocket::response_type& response) {
          response.set(http::field::sec_websocket_protocol, protocol);
        }));
    page_.async_accept(request, [self = shared_from_this()](const error_code& error) {
      if (error || self->desk_->closed) return;
      ++self->desk_->counts.connections;
      for (const auto& address : self->desk_->options.servers) self->Follow(address);
      self->Read();
      self->Write();
    });
  }

 private:
  struct Followed {
    std::string name;  ///< As the server calls itself.
    std::unique_ptr<transport::Client> client;
  };

  void Follow(const transport::Address& address) {
    Followed& followed = *followed_.emplace_back(std::make_unique<Followed>());
    transport::ClientOptions options;
    options.address = address;
    options.client_name = "web: Foxglove";
    options.max_hz = foxglove_scene::Scene::kMostHz;
    options.policy = v1::QUEUE_POLICY_LATEST;
    transport::ClientHandlers handlers;
    handlers.on_welcome = [&followed](const v1::Welcome& welcome) {
      followed.name = welcome.server_id();
    };
    handlers.on_tick = [this, &followed](const v1::Tick& tick) {
      if (over_) return;
      feed_.OnTick(followed.name, tick, {tick.host_ns(), tick.host_ns(), 0});
      Write();
    };
    handlers.on_gap = [](const v1::Gap&) {};
    handlers.on_state = [](transport::LinkState, const std::string&) {};
    followed.client =
        std::make_unique<transport::Client>(desk_->io, std::move(options), std::move(handlers));
    followed.client->Start();
  }

  void Read() {
    page_.async_read(from_page_, [self = shared_from_this()](const error_code& error, std::size_t) {
      if (error || self->over_ || self->desk_->closed) return self->End();
      if (self->page_.got_text()) {
        const auto data = self->from_page_.cdata();
        const auto taken = self->feed_.Take({static_cast<const char*>(data.data()), data.size()});
        if (!taken) return self->End();
      }
      self->from_page_.consume(self->from_page_.size());
      self->Write();
      self->Read();
    });
  }

  void Write() {
    if (writes_ || over_) return;
    auto message = feed_.Next();
    if (!message) return;
    to_page_ = std::move(message->bytes);
    page_.text(message->is_text);
    writes_ = true;
    page_.async_write(asio::buffer(to_page_),
                      [self = shared_from_this()](const error_code& error, std::size_t) {
                        self->writes_ = false;
                        if (error || self->desk_->closed) return self->End();
                        self->Write();
                      });
  }

  void End() {
    over_ = true;
    for (const auto& followed : followed_) followed->client->Stop();
    page_.next_layer().socket().Close();
  }

  websocket::stream<Stream> page_;
  std::shared_ptr<Desk> desk_;
  const http_server::Place place_;
  FoxgloveFeed feed_;
  std::vector<std::unique_ptr<Followed>> followed_;
  boost::beast::flat_buffer from_page_;
  std::string to_page_;
  bool writes_ = false;
  bool over_ = false;
};

/// The page for a webcam: each binary message is an OSC packet, which goes on to footing-skeleton;
/// what is wrong there goes back as text.
class SkeletonSocket : public std::enable_shared_from_this<SkeletonSocket> {
 public:
  SkeletonSocket(Stream stream, std::shared_ptr<Desk> desk, http_server::Place place)
      : page_(std::move(stream)),
        desk_(std::move(desk)),
        place_(std::move(place)),
        out_(desk_->io) {}

  void Start(const Request& request) {
    page_.set_option(websocket::stream_base::timeout{std::chrono::seconds(5), kIdle, true});
    page_.read_message_max(osc::kMostPacketBytes);
    page_.async_accept(request, [self = shared_from_this()](const error_code& error) {
      if (error || self->desk_->closed) return;
      ++self->desk_->counts.connections;
      error_code failed;
      self->out_.connect({asio::ip::address_v4::loopback(), self->desk_->options.skeleton_port},
                         failed);
      self->Read();
    });
  }

 private:
  void Read() {
    page_.async_read(from_page_, [self = shared_from_this()](const error_code& error, std::size_t) {
      if (error || self->desk_->closed) return;
      if (self->page_.got_binary()) self->Forward();
      self->from_page_.consume(self->from_page_.size());
      self->Read();
    });
  }

  /// Where nobody listens, only every other packet says so.
  void Forward() {
    const std::int64_t now_ns = clock::MonotonicNs();
    error_code error;
    out_.send(from_page_.cdata(), 0, error);
    if (error) lost_ns_ = now_ns;
    const bool lost = lost_ns_ != 0 && now_ns - lost_ns_ < kSkeletonsLostNs;
    if (writes_ || lost == said_lost_) return;
    said_lost_ = lost;
    to_page_ = lost ? "footing-skeleton does not listen at UDP port " +
                          std::to_string(desk_->options.skeleton_port) + " of this host: start it"
                    : "";
    writes_ = true;
    page_.text(true);
    page_.async_write(
        asio::buffer(to_page_),
        [self = shared_from_this()](const error_code&, std::size_t) { self->writes_ = false; });
  }

  websocket::stream<Stream> page_;
  std::shared_ptr<Desk> desk_;
  const http_server::Place place_;
  asio::ip::udp::socket out_;
  boost::beast::flat_buffer from_page_;
  std::string to_page_;
  std::int64_t lost_ns_ = 0;  ///< When a packet was refused last.
  bool said_lost_ = false, writes_ = false;
};

/// The right that a page needs.
Right RightFor(std::string_view page, bool secure) {
  if (page == "/phone") return Right::kDevices;
  if (page == "/participant") return Right::kAnswer;
  // On this host everybody can send to footing-skeleton without a page.
  if (page == "/webcam") return secure ? Right::kDevices : Right::kView;
  return Right::kView;
}

/// The file of that name in the pose model's package; empty where the name is not that of a file
/// directly in it.
std::filesystem::path ModelFile(const std::filesystem::path& package, std::string_view name) {
  if (name.empty() || name[0] == '.' || name.find('/') != std::string_view::npos) return {};
  std::error_code error;
  const std::filesystem::path path = package / name;
  return std::filesystem::is_regular_file(path, error) ? path : std::filesystem::path();
}

/// One listener's view of the desk.
class Reception {
 public:
  Reception(std::shared_ptr<Desk> desk, bool secure) : desk_(std::move(desk)), secure_(secure) {}

  Answer AnswerTo(const Request* request) {
    if (request == nullptr) return Refuse(http::status::bad_request, "this is not a request\n");
    if (!IsOwnHost((*request)[http::field::host], desk_->options.host_names)) {
      return Refuse(http::status::forbidden,
                    "this host is not called so; use its numeric address, or name it with "
                    "footing-web --host-name\n");
    }
    const std::string_view target = PathOf(*request);
    if (websocket::is_upgrade(*request)) return RefuseSocket(*request);
    if (request->method() == http::verb::post) return Post(*request, target);
    if (request->method() != http::verb::get && request->method() != http::verb::head) {
      return Refuse(http::status::method_not_allowed, "there are GET and POST\n");
    }
    if (target == "/about.json") return About(*request);
    if (target == "/footing.crt" && secure_) {
      return {http::status::ok, "application/x-x509-ca-cert", desk_->identity->CertificatePem()};
    }
    if (target.starts_with(kModelPrefix)) return Model(*request, target);
    return File(*request, target);
  }

  bool Upgrade(const Request& request, Stream& stream, const http_server::Place& place) {
    if (!websocket::is_upgrade(request)) return false;
    if (!IsOwnHost(request[http::field::host], desk_->options.host_names)) return false;
    if (const std::string_view protocol = ProtocolOf(request); !protocol.empty()) {
      if (!WhyNoFoxglove(request).empty()) return false;
      std::make_shared<FoxgloveSocket>(std::move(stream), desk_, place)->Start(request, protocol);
      return true;
    }
    if (!IsOwnOrigin(request)) return false;
    if (PathOf(request) == "/skeleton" && MayTrack(request)) {
      std::make_shared<SkeletonSocket>(std::move(stream), desk_, place)->Start(request);
      return true;
    }
    const auto socket = SocketOf(request);
    if (!socket || RightOf(request) < socket->needs) return false;
    std::make_shared<Bridge>(std::move(stream), desk_, place, socket->address, socket->carries)
        ->Start(request);
    return true;
  }

 private:
  struct SocketTarget {
    transport::Address address;
    Carries carries;
    Right needs;
  };

  static std::string_view PathOf(const Request& request) {
    const std::string_view target(request.target().data(), request.target().size());
    return target.substr(0, target.find('?'));
  }

  std::optional<SocketTarget> SocketOf(const Request& request) const {
    const std::string_view target = PathOf(request);
    constexpr std::string_view kSession = "/session/";
    if (target == "/devices" && desk_->options.devices) {
      return SocketTarget{*desk_->options.devices, Carries::kDevices, Right::kDevices};
    }
    if (target == "/survey" && desk_->options.survey) {
      return SocketTarget{*desk_->options.survey, Carries::kSurvey,
                          RightFor("/participant", secure_)};
    }
    if (!target.starts_with(kSession)) return std::nullopt;
    const auto index = text::ToCount(std::string(target.substr(kSession.size())));
    if (!index || *index >= desk_->options.servers.size()) return std::nullopt;
    return SocketTarget{desk_->options.servers[*index], Carries::kSession, Right::kView};
  }

  bool IsOwnOrigin(const Request& request) const {
    const std::string host(request[http::field::host]);
    return request[http::field::origin] == (secure_ ? "https://" : "http://") + host;
  }

  /// On this host everybody may view; elsewhere, and to attach devices, a pass is needed.
  Right RightOf(const Request& request) const {
    const std::string_view pass = CookieIn(request[http::field::cookie], kCookie);
    return std::max(desk_->passes.RightOf(pass, clock::MonotonicNs()),
                    secure_ ? Right::kNone : Right::kView);
  }

  /// How a browser gets more rights.
  std::string NeedsCode(const Request& request) const {
    const std::string_view pass = CookieIn(request[http::field::cookie], kCookie);
    const bool had =
        !pass.empty() && desk_->passes.RightOf(pass, clock::MonotonicNs()) == Right::kNone;
    return (had ? "footing-web was restarted or 12 hours have passed, so this browser needs a new "
                  "code"
                : std::string("this browser needs a code")) +
           ": scan the QR code that footing-web shows";
  }

  bool MayTrack(const Request& request) const {
    return RightOf(request) >= RightFor("/webcam", secure_);
  }

  Answer Refuse(http::status status, const std::string& why) {
    ++desk_->counts.refused;
    return {status, kText, why};
  }

  static std::string_view ProtocolOf(const Request& request) {
    const auto offered = request[http::field::sec_websocket_protocol];
    return FoxgloveProtocol({offered.data(), offered.size()});
  }

  /// Why this program may not draw with Foxglove's protocol; empty: it may. One that is not a
  /// browser names no origin.
  std::string WhyNoFoxglove(const Request& request) const {
    if (!desk_->options.foxglove) {
      return "Foxglove's protocol is off; start footing-web with --foxglove\n";
    }
    if (secure_) {
      return "Foxglove's protocol is for programs of this host; from another one go through ssh "
             "-L\n";
    }
    const std::string origin(request[http::field::origin]);
    const auto& known = desk_->options.origins;
    if (origin.empty() || IsOwnOrigin(request) ||
        std::find(known.begin(), known.end(), origin) != known.end()) {
      return "";
    }
    return "pages of " + origin.substr(0, 200) +
           " are refused; if you trust it, start footing-web with " + "--origin " +
           origin.substr(0, 200) + "\n";
  }

  Answer RefuseSocket(const Request& request) {
    if (!ProtocolOf(request).empty()) {
      const std::string why = WhyNoFoxglove(request);
      if (std::exchange(desk_->refused_foxglove, why) != why) {
        log::Warning(why.substr(0, why.find('\n')));
      }
      return Refuse(http::status::forbidden, why);
    }
    if (!IsOwnOrigin(request)) {
      return Refuse(http::status::forbidden, "pages of other origins are refused\n");
    }
    if (!SocketOf(request) && PathOf(request) != "/skeleton") {
      return Refuse(http::status::not_found, "this socket does not exist\n");
    }
    return Refuse(http::status::forbidden, NeedsCode(request) + "\n");
  }

  /// A code becomes a pass.
  Answer Post(const Request& request, std::string_view target) {
    if (!IsOwnOrigin(request)) {
      return Refuse(http::status::forbidden, "pages of other origins are refused\n");
    }
    if (target == "/devices") return PostDevices(request);
    if (target != "/enter") return Refuse(http::status::not_found, "this page does not exist\n");
    const auto pass = desk_->passes.Redeem(request.body(), clock::MonotonicNs());
    if (!pass) {
      return Refuse(http::status::forbidden,
                    "this code was used or is too old: scan the QR code again\n");
    }
    ++desk_->counts.codes_used;
    KeepPasses(*desk_);
    return {http::status::no_content,
            "",
            "",
            {},
            {{"Set-Cookie", std::string(kCookie) + "=" + *pass +
                                "; Path=/; HttpOnly; SameSite=Strict; Max-Age=" +
                                std::to_string(static_cast<int>(Passes::kPassLastsS)) +
                                (secure_ ? "; Secure" : "")}}};
  }

  /// Reports of a phone whose browser opens no WebSocket.
  Answer PostDevices(const Request& request) {
    if (!desk_->options.devices || RightOf(request) < Right::kDevices) {
      return Refuse(http::status::forbidden, NeedsCode(request) + "\n");
    }
    const std::string pass(CookieIn(request[http::field::cookie], kCookie));
    std::shared_ptr<Mailbox>& mailbox = desk_->mailboxes[pass];
    if (!mailbox || mailbox->over()) {
      mailbox = std::make_shared<Mailbox>(desk_->io, *desk_->options.devices);
      mailbox->Start();
    }
    mailbox->away().After(Mailbox::kAwayS,
                          [desk = desk_.get(), pass] { desk->mailboxes.erase(pass); });
    auto answer = mailbox->Take(request.body());
    if (!answer) {
      desk_->mailboxes.erase(pass);
      return Refuse(http::status::bad_request, answer.error().message + "\n");
    }
    return {http::status::ok, "application/octet-stream", std::move(answer).value()};
  }

  Answer About(const Request& request) const {
    const Right right = RightOf(request);
    const nlohmann::json about = {{"version", cli::Version()},
                                  {"servers", desk_->options.servers.size()},
                                  {"may_view", right >= Right::kView},
                                  {"may_attach", right >= Right::kDevices},
                                  {"may_answer", right >= Right::kAnswer},
                                  {"may_track", MayTrack(request)},
                                  {"needs_code", NeedsCode(request)},
                                  {"devices", desk_->options.devices.has_value()}};
    return {http::status::ok, "application/json", about.dump() + "\n"};
  }

  Answer Model(const Request& request, std::string_view target) {
    const std::filesystem::path file =
        MayTrack(request)
            ? ModelFile(desk_->options.pose_package, target.substr(kModelPrefix.size()))
            : std::filesystem::path();
    if (file.empty()) {
      return Refuse(http::status::not_found,
                    "@mediapipe/pose has no such file; run scripts/fetch-pose-model\n");
    }
    const char* const type = file.extension() == ".js"     ? "text/javascript"
                             : file.extension() == ".wasm" ? "application/wasm"
                                                           : "application/octet-stream";
    return {.type = type, .file = file};
  }

  Answer File(const Request& request, std::string_view target) {
    target.remove_prefix(target.starts_with('/') ? 1 : 0);
    std::string name(target.empty() ? "index" : target);
    if (name.find('.') == std::string::npos) name += ".html";
    const auto& files = PageFiles();
    const auto file = std::find_if(files.begin(), files.end(),
                                   [&name](const PageFile& one) { return one.name == name; });
    if (file == files.end()) return Refuse(http::status::not_found, "this page does not exist\n");
    http_server::Headers headers = {{"ETag", std::string(file->etag)}};
    if (name == "webcam.html") {
      headers.insert(headers.end(), {{"Content-Security-Policy", kWebcamPolicy},
                                     {"Permissions-Policy", kWebcamPermissions}});
    }
    if (request[http::field::if_none_match] == file->etag) {
      return {http::status::not_modified, "", "", {}, headers};
    }
    headers.emplace_back("Content-Encoding", "gzip");
    return {http::status::ok, std::string(file->type), std::string(file->gzip), {}, headers};
  }

  std::shared_ptr<Desk> desk_;
  const bool secure_;
};

/// The identity of tls:, with the names that browsers look for.
Result<void> LoadIdentity(Desk& desk) {
  const std::string file =
      desk.options.identity_file.empty() ? tls::DefaultIdentityFile() : desk.options.identity_file;
  auto identity = tls::Identity::LoadOrMake(file, "Footing");
  if (!identity) return identity.error();
  desk.identity = std::move(identity).value();
  desk.passes_file = std::filesystem::path(file).replace_filename(kPassesFile);
  return {};
}

/// As browsers call this host. No browser can open 0.0.0.0, on which it may listen.
std::string CalledHost(const Desk& desk, const transport::Address& address) {
  if (!desk.options.host_names.empty()) return desk.options.host_names.front();
  if (!transport::IsEveryAddress(address.host)) return address.host;
  const std::string own = transport::AddressForOthers();
  return own.empty() ? address.host : own;
}

/// Says by which name QR codes call a host that listens on every address.
void SayCalledHost(const Desk& desk) {
  for (const auto& server : desk.servers) {
    const transport::Address& address = server->address();
    if (address.kind != transport::Address::Kind::kTls) continue;
    if (!transport::IsEveryAddress(address.host)) continue;
    const std::string called = CalledHost(desk, address);
    if (transport::IsEveryAddress(called)) {
      log::Warning("no other host can open " + address.Text() +
                   ", and this one is in no network; name its address with --host-name");
    } else {
      log::Info("QR codes for " + address.Text() + " name " + called +
                "; --host-name names another address");
    }
  }
}

/// Says what is wrong with the certificate, now and every day.
void CheckCertificate(Desk& desk) {
  for (const auto& server : desk.servers) {
    if (server->address().kind != transport::Address::Kind::kTls) continue;
    const std::string host = CalledHost(desk, server->address());
    const std::string fault =
        desk.identity->FaultFor(host, clock::WallNs() / kNanosecondsPerSecond);
    if (fault.empty()) continue;
    log::Warning("the certificate " + fault + ", so browsers refuse https://" + host +
                 "; renew it or name the right host, and restart footing-web (Certificates in "
                 "docs/web.md)");
  }
  desk.certificate_check.After(std::chrono::hours(24), [&desk] { CheckCertificate(desk); });
}

Result<std::unique_ptr<http_server::Server>> Listen(const std::shared_ptr<Desk>& desk,
                                                    const transport::Address& address) {
  const bool secure = address.kind == transport::Address::Kind::kTls;
  if (!secure && !transport::StaysOnThisHost(address)) {
    return UsageError("--listen " + address.Text() +
                      ": beyond this host pages go by tls: only, for example tls:" + address.host +
                      ":" + std::to_string(address.port));
  }
  transport::ListenSecurity security;
  security.tls = [desk]() -> Result<tls::Context> {
    if (const auto loaded = LoadIdentity(*desk); !loaded) return loaded.error();
    return tls::Context::ForServer(*desk->identity);
  };
  const auto reception = std::make_shared<Reception>(desk, secure);
  http_server::Options options;
  options.most_connections = kMostConnections;
  options.most_header_bytes = http_server::kMostHeaderBytes;
  options.most_body_bytes = kMostBodyBytes;
  options.next_within = std::chrono::seconds(10);
  options.headers = {
      {"Cache-Control", "no-cache"},        {"X-Content-Type-Options", "nosniff"},
      {"Referrer-Policy", "no-referrer"},   {"Cross-Origin-Opener-Policy", "same-origin"},
      {"Permissions-Policy", kPermissions}, {"Content-Security-Policy", kPolicy}};
  options.answer = [reception](const Request* request) { return reception->AnswerTo(request); };
  options.upgrade = [reception](const Request& request, Stream& stream,
                                const http_server::Place& place) {
    return reception->Upgrade(request, stream, place);
  };
  return http_server::Server::Open(desk->io, address, std::move(options), security);
}

}  // namespace

Result<std::unique_ptr<WebServer>> WebServer::Open(asio::io_context& io, WebOptions options) {
  auto desk = std::make_shared<Desk>(io, std::move(options));
  for (const transport::Address& address : desk->options.listen) {
    if (!address.OverTcp()) {
      return UsageError("--listen " + address.Text() + ": must be tcp:HOST:PORT or tls:HOST:PORT");
    }
    auto server = Listen(desk, address);
    if (!server) return server.error();
    desk->servers.push_back(std::move(*server));
  }
  if (desk->identity) {
    CheckCertificate(*desk);
    FindPasses(*desk);
  }
  SayCalledHost(*desk);
  return std::unique_ptr<WebServer>(new WebServer(std::move(desk)));
}

WebServer::WebServer(std::shared_ptr<Desk> desk) : desk_(std::move(desk)) {}

WebServer::~WebServer() {
  desk_->closed = true;
  desk_->mailboxes.clear();
  desk_->servers.clear();
}

std::string WebServer::Invite(std::string_view page) {
  // Beyond this host where it listens there: that is the one for a phone.
  transport::Address address = desk_->servers.front()->address();
  for (const auto& server : desk_->servers) {
    if (server->address().kind == transport::Address::Kind::kTls) address = server->address();
  }
  const bool secure = address.kind == transport::Address::Kind::kTls;
  const std::string host = secure ? CalledHost(*desk_, address) : address.host;
  const bool is_v6 = host.find(':') != std::string::npos;
  const std::string url = (secure ? "https://" : "http://") + (is_v6 ? "[" + host + "]" : host) +
                          ":" + std::to_string(address.port) + std::string(page);
  const Right right = RightFor(page, secure);
  if (!secure && right <= Right::kView) return url;
  return url + "#" + desk_->passes.NewCode(right, clock::MonotonicNs());
}

std::filesystem::path DefaultPosePackage() {
  const char* const data = std::getenv("XDG_DATA_HOME");
  const char* const home = std::getenv("HOME");
  const std::filesystem::path base =
      data != nullptr && *data != '\0'
          ? std::filesystem::path(data)
          : std::filesystem::path(home != nullptr ? home : "/") / ".local/share";
  return base / "footing/mediapipe-pose";
}

const WebCounts& WebServer::counts() const { return desk_->counts; }

std::vector<transport::Address> WebServer::addresses() const {
  std::vector<transport::Address> addresses;
  for (const auto& server : desk_->servers) addresses.push_back(server->address());
  return addresses;
}

std::string WebServer::fingerprint() const {
  return desk_->identity ? desk_->identity->fingerprint() : "";
}

}  // namespace footing::web
