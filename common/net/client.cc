#include "common/net/client.h"

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <string_view>
#include <utility>

#include <unistd.h>

#include "common/base/units.h"
#include "common/net/access.h"
#include "common/net/address.h"
#include "common/net/admission.h"
#include "common/net/clock_offset.h"
#include "common/net/framing.h"
#include "common/net/known_servers.h"
#include "common/net/limits.h"
#include "common/net/socket.h"
#include "common/net/tls_context.h"
#include "common/runtime/clock.h"
#include "common/runtime/log.h"
#include "common/runtime/timer.h"

namespace footing::transport {
class Client::Implementation : public std::enable_shared_from_this<Implementation> {
 public:
  Implementation(boost::asio::io_context& io, ClientOptions options, ClientHandlers handlers)
      : io_(io),
        options_(std::move(options)),
        handlers_(std::move(handlers)),
        redial_(io, options_.backoff_min_s, options_.backoff_max_s),
        pulse_(io) {}

  void Start() {
    if (started_) return;
    started_ = true;
    Connect();
  }

  void Stop() {
    started_ = false;
    subscribed_ = false;
    ++attempt_;  // A dial under way is forgotten.
    redial_.cancel();
    pulse_.cancel();
    connection_.reset();
    wish_.reset();
    why_ = "the client was stopped";
    commands_.Fail(why_);
  }

  void Finish(const std::string& reason) {
    started_ = subscribed_ = false;
    ++attempt_;
    redial_.cancel();
    pulse_.cancel();
    Break(reason);
  }

  bool SendDevice(const v1::DeviceEnvelope& device) {
    const bool short_enough = device.ByteSizeLong() <= kMaxDeviceBytes;
    if (!subscribed_ || !connection_ || !short_enough) return false;
    v1::Envelope message;
    *message.mutable_device() = device;
    return connection_->Send(message.SerializeAsString());
  }

  void Send(v1::Command command, const PendingCommands::Done& done) {
    if (!subscribed_) return commands_.Refuse(done, "not connected: " + why_);
    auto sent = commands_.Add(std::move(command), done, NowNs());
    if (!sent) return;
    v1::Envelope message;
    *message.mutable_command() = std::move(*sent);
    SendMessage(message);
  }

  void Refill(std::uint64_t from_sequence, std::uint64_t to_sequence) {
    if (subscribed_) SendMessage(MakeRefill(from_sequence, to_sequence));
  }

  LinkState state() const { return state_; }
  ClockOffset clock() const { return probes_.offset(); }

 private:
  /// Why the server ends a connection.
  struct CloseReason {
    bool refused = false;
    std::string text;  ///< Empty: it gave none.
  };

  std::int64_t NowNs() const { return options_.now_ns ? options_.now_ns() : clock::MonotonicNs(); }

  void Connect() {
    Dial(io_, options_.address,
         [weak = weak_from_this(), attempt = ++attempt_](Result<Socket> socket) {
           const auto self = weak.lock();
           if (!self || attempt != self->attempt_) return;
           if (!socket) {
             self->Retry(LinkState::kConnecting,
                         WaitingText(socket.error().message, self->close_.text));
             return;
           }
           self->OnConnected(std::move(*socket));
         });
  }

  void OnConnected(Socket socket) {
    const auto hello = MakeHello(options_);
    if (!hello) return Retry(LinkState::kRefused, hello.error().message);
    FramedLimits limits{.max_in_bytes = options_.max_message_bytes,
                        .max_queued_frames = options_.max_queued_frames};
    FramedHandlers handlers;
    // Each keeps this alive while it is called: a handler may destroy the client.
    handlers.on_frame = [weak = weak_from_this()](std::string_view payload) {
      const auto self = weak.lock();
      if (!self) return;
      self->OnFrame(payload);
      self->parser_.Discard();
    };
    handlers.on_bytes = [weak = weak_from_this()] {
      if (const auto self = weak.lock()) self->heard_ns_ = self->NowNs();
    };
    handlers.on_close = [weak = weak_from_this()](const std::string& reason) {
      if (const auto self = weak.lock()) self->OnClose(reason);
    };
    handlers.on_untrusted = [weak = weak_from_this()](const std::string& why) {
      if (const auto self = weak.lock()) self->close_ = {true, why};
    };
    connection_.emplace(std::move(socket), limits, std::move(handlers));
    connection_->Start();
    heard_ns_ = NowNs();
    close_.text.clear();
    SendMessage(*hello);
    ArmPulse();
  }

  void OnFrame(std::string_view payload) {
    const v1::Envelope* const parsed = parser_.Parse(payload);
    if (parsed == nullptr) {
      return Break("the server sent bytes that are not a message of Footing's protocol");
    }
    const v1::Envelope& message = *parsed;
    if (state_ == LinkState::kStale) SetState(LinkState::kLive, LiveText());
    if (!connection_) return;  // The handler stopped us.
    switch (message.body_case()) {
      case v1::Envelope::kTick:
        return OnTick(message.tick());
      case v1::Envelope::kGap:
        return Call(handlers_.on_gap, message.gap());
      case v1::Envelope::kPing:
        return SendMessage(MakePong(message.ping(), heard_ns_, NowNs()));
      case v1::Envelope::kPong:
        return OnPong(message.pong());
      case v1::Envelope::kCommandResult:
        return commands_.TakeAnswer(message.command_result());
      case v1::Envelope::kWelcome:
        return OnWelcome(message.welcome());
      case v1::Envelope::kNotice:
        return Call(handlers_.on_notice, message.notice());
      case v1::Envelope::kSubscribed:
        return OnSubscribed();
      case v1::Envelope::kDevice:
        return Call(handlers_.on_device, message.device());
      case v1::Envelope::kRefused:
        close_ = {true, options_.address.Text() + " refused: " + message.refused().message()};
        return Call(handlers_.on_refused, message.refused());
      case v1::Envelope::kGoodbye:
        close_.text = message.goodbye().reason();
        return;
      default:  // Message of a later minor version.
        return;
    }
  }

  void OnWelcome(const v1::Welcome& welcome) {
    probes_.OnWelcome(welcome.epoch() != server_.epoch);  // Perhaps another host.
    server_.name = welcome.server_id() + " " + welcome.version();
    if (options_.attaches_devices) return OnDevicesWelcome(welcome);
    wish_ = MakeSubscribe(options_, welcome.epoch(), server_.last_epoch, server_.last_sequence);
    server_.epoch = welcome.epoch();
    SendPing();
    Call(handlers_.on_welcome, welcome);
  }

  void OnDevicesWelcome(const v1::Welcome& welcome) {
    Call(handlers_.on_welcome, welcome);
    const auto& can = welcome.capabilities();
    if (std::find(can.begin(), can.end(), "devices") != can.end()) return OnSubscribed();
    close_ = {true, options_.address.Text() + " is " + server_.name +
                        ", which takes no devices of other hosts; start footingd with --source "
                        "stream:tls:HOST:PORT"};
    Break(close_.text);
  }

  void Subscribe() { SendMessage(*std::exchange(wish_, std::nullopt)); }

  void OnSubscribed() {
    subscribed_ = true;
    redial_.Reset();
    SetState(LinkState::kLive, LiveText());
  }

  std::string LiveText() const {
    return "connected to " + server_.name + " on " + options_.address.Text();
  }

  void OnTick(const v1::Tick& tick) {
    if (!tick.snapshot()) server_.Take(tick.sequence());
    Call(handlers_.on_tick, tick);
  }

  void OnPong(const v1::Pong& pong) {
    probes_.Take(pong, heard_ns_);
    if (wish_) probes_.settled() ? Subscribe() : SendPing();
  }

  void SendPing() { SendMessage(probes_.Next(NowNs())); }

  void SendMessage(const v1::Envelope& message) {
    if (connection_) connection_->Send(message.SerializeAsString());
  }

  void ArmPulse() {
    pulse_.After(options_.ping_interval_s, [this] {
      const auto self = shared_from_this();  // A handler may destroy the client.
      if (connection_) OnPulse();
    });
  }

  void OnPulse() {
    const std::int64_t now_ns = NowNs();
    if (WasLate(pulse_)) heard_ns_ = now_ns;  // It was us who stood still.
    const double silent_s = NanosecondsToSeconds(now_ns - heard_ns_);
    commands_.Expire(now_ns);
    if (!connection_) return;  // A handler stopped us.
    const double patience_s = subscribed_ ? options_.dead_after_s : options_.stale_after_s;
    if (silent_s > patience_s) return Break(options_.address.Text() + " stopped answering");
    if (subscribed_ && silent_s > options_.stale_after_s && state_ == LinkState::kLive) {
      SetState(LinkState::kStale, "nothing comes from " + server_.name + " on " +
                                      options_.address.Text() + "; waiting");
    }
    if (wish_) Subscribe();  // On a slow link, with fewer pings.
    if (subscribed_) SendPing();
    ArmPulse();
  }

  /// Ends this connection from our side; the next one is dialled later.
  void Break(const std::string& why) {
    if (connection_) connection_->Finish("", why);
  }

  void OnClose(const std::string& reason) {
    const auto self = shared_from_this();  // A handler may let the client go.
    const bool refused = std::exchange(close_.refused, false);
    const std::string words = close_.text.empty() ? reason : close_.text;
    connection_.reset();
    wish_.reset();
    subscribed_ = false;
    pulse_.cancel();
    Retry(refused ? LinkState::kRefused : LinkState::kConnecting,
          refused ? words : "waiting for " + options_.address.Text() + ": " + words);
    // After the state: who asks for it on a failure must not find the lost link alive.
    commands_.Fail("the connection was lost before the answer; it may still be carried out");
  }

  void Retry(LinkState state, const std::string& why) {
    if (!started_) return;
    const auto connect = [this] {
      const auto self = shared_from_this();  // A handler may destroy the client.
      if (started_) Connect();
    };
    if (state == LinkState::kRefused) {
      redial_.Within(options_.refused_wait_s, connect);
    } else {
      redial_.Later(connect);
    }
    SetState(state, why);
  }

  void SetState(LinkState state, const std::string& why) {
    if (state_ == state && why_ == why) return;
    state_ = state;
    why_ = why;
    if (const auto handler = handlers_.on_state) handler(state, why);
  }

  static void Call(const auto& handler, const auto& message) {
    if (handler) handler(message);
  }

  boost::asio::io_context& io_;
  const ClientOptions options_;
  ClientHandlers handlers_;
  std::optional<FramedConnection> connection_;
  Redial redial_;
  timer::Timer pulse_;
  bool started_ = false;
  bool subscribed_ = false;
  std::uint64_t attempt_ = 0;
  LinkState state_ = LinkState::kConnecting;
  std::string why_ = "not started";
  ServerPosition server_;
  CloseReason close_;
  std::int64_t heard_ns_ = 0;
  PendingCommands commands_;
  ClockProbes probes_;
  std::optional<v1::Envelope> wish_;  ///< The Subscribe to send once the clock is known.
  MessageParser parser_;
};

Client::Client(boost::asio::io_context& io, ClientOptions options, ClientHandlers handlers)
    : implementation_(
          std::make_shared<Implementation>(io, std::move(options), std::move(handlers))) {}
Client::~Client() { implementation_->Stop(); }
void Client::Start() { implementation_->Start(); }
void Client::Stop() { implementation_->Stop(); }
void Client::Send(v1::Command command, std::function<void(const v1::CommandResult&)> done) {
  implementation_->Send(std::move(command), std::move(done));
}
void Client::Finish(const std::string& reason) { implementation_->Finish(reason); }
bool Client::SendDevice(const v1::DeviceEnvelope& message) {
  return implementation_->SendDevice(message);
}
void Client::Refill(std::uint64_t from_sequence, std::uint64_t to_sequence) {
  implementation_->Refill(from_sequence, to_sequence);
}
LinkState Client::state() const { return implementation_->state(); }
ClockOffset Client::clock() const { return implementation_->clock(); }

namespace {

bool MaySendSecretTo(const Address& address) {
  if (address.kind != Address::Kind::kTcp || StaysOnThisHost(address)) return true;
  const char* const allowed = std::getenv("FOOTING_INSECURE_LAN");
  return allowed != nullptr && std::string_view(allowed) == "1";
}

}  // namespace

Result<v1::Envelope> MakeHello(const ClientOptions& options) {
  const bool ask_environment = options.token.empty() && options.address.OverTcp();
  const auto token = ask_environment ? TokenFromEnvironment() : Result<std::string>(options.token);
  if (!token) return token.error();
  if (!token->empty() && !MaySendSecretTo(options.address)) {
    return UsageError(options.address.Text() +
                      ": the token is not sent without encryption; connect with tls:HOST:PORT, or, "
                      "in a network that you trust wholly, set FOOTING_INSECURE_LAN=1");
  }
  v1::Envelope message;
  v1::Hello& hello = *message.mutable_hello();
  hello.set_protocol_major(kProtocolMajor);
  hello.set_protocol_minor(kProtocolMinor);
  hello.set_role(options.role);
  hello.set_token(*token);
  hello.set_client_name(options.client_name);
  return message;
}

v1::Envelope MakeSubscribe(const ClientOptions& options, std::uint64_t epoch,
                           std::uint64_t last_epoch, std::uint64_t last_sequence) {
  v1::Envelope message;
  v1::Subscribe& wish = *message.mutable_subscribe();
  for (const auto& channel : options.channels) wish.add_channels(channel);
  wish.set_max_hz(options.max_hz);
  wish.set_policy(options.policy);
  wish.set_queue_ticks(options.queue_ticks);
  if (last_sequence != 0 && options.policy != v1::QUEUE_POLICY_LATEST) {
    wish.set_from_sequence(last_sequence + 1);
    wish.set_from_epoch(last_epoch);
  } else if (options.from_ring_start) {
    wish.set_from_sequence(0);  // Whatever the ring holds.
    wish.set_from_epoch(epoch);
  }
  return message;
}

v1::Envelope MakeRefill(std::uint64_t from_sequence, std::uint64_t to_sequence) {
  v1::Envelope message;
  message.mutable_refill()->set_from_sequence(from_sequence);
  message.mutable_refill()->set_to_sequence(to_sequence);
  return message;
}

v1::Envelope MakePing(std::uint64_t id, std::int64_t now_ns) {
  v1::Envelope message;
  message.mutable_ping()->set_id(id);
  message.mutable_ping()->set_t0_ns(now_ns);
  return message;
}

v1::Envelope MakePong(const v1::Ping& ping, std::int64_t arrived_ns, std::int64_t now_ns) {
  v1::Envelope message;
  v1::Pong& pong = *message.mutable_pong();
  pong.set_id(ping.id());
  pong.set_t0_ns(ping.t0_ns());
  pong.set_t1_ns(arrived_ns);
  pong.set_t2_ns(now_ns);
  return message;
}

std::string WaitingText(const std::string& dial_error, const std::string& last_reason) {
  return "cannot connect to " + dial_error + RemedyFor(dial_error, "") +
         (last_reason.empty() ? "" : "; the last one said: " + last_reason);
}

namespace {

constexpr std::size_t kMaxWaitingCommands = 64;

v1::CommandResult FailedCommand(std::uint64_t id, const std::string& why) {
  v1::CommandResult result;
  result.set_id(id);
  result.set_message(why);
  return result;
}

}  // namespace

std::optional<v1::Command> PendingCommands::Add(v1::Command command, const Done& done,
                                                std::int64_t now_ns) {
  command.set_id(++last_id_);
  if (waiting_.size() >= kMaxWaitingCommands) {
    done(FailedCommand(command.id(), "too many commands wait for their answers"));
    return std::nullopt;
  }
  const std::uint32_t deadline_ms =
      command.deadline_ms() == 0 ? kDefaultDeadlineMs : command.deadline_ms();
  waiting_[command.id()] = {done, now_ns + std::int64_t{deadline_ms} * kNanosecondsPerMillisecond};
  return command;
}

void PendingCommands::Refuse(const Done& done, const std::string& why) {
  done(FailedCommand(++last_id_, why));
}

void PendingCommands::TakeAnswer(const v1::CommandResult& answer) {
  const auto found = waiting_.find(answer.id());
  if (found == waiting_.end()) return;
  const Done done = std::move(found->second.done);
  waiting_.erase(found);
  done(answer);
}

void PendingCommands::Expire(std::int64_t now_ns) {
  for (auto next = waiting_.begin(); next != waiting_.end();) {
    const auto one = next++;
    if (now_ns < one->second.deadline_ns) continue;
    const Done done = std::move(one->second.done);
    const std::uint64_t id = one->first;
    waiting_.erase(one);
    done(FailedCommand(id, "no answer within its deadline; it may still be carried out"));
  }
}

void PendingCommands::Fail(const std::string& why) {
  const auto waiting = std::exchange(waiting_, {});
  for (const auto& [id, one] : waiting) one.done(FailedCommand(id, why));
}

std::shared_ptr<ServerTrust> ServerTrust::Of(const Address& address) {
  return std::make_shared<ServerTrust>(KnownName(address),
                                       tls::KnownServers(tls::KnownServersFile()));
}

std::string ServerTrust::WhyRefused(const std::string& fingerprint) {
  const auto known = known_.Find(server_);
  if (!known) return "not connected to tls:" + server_ + ": " + known.error().message;
  if (*known) {
    if (**known == fingerprint) return "";
    return "tls:" + server_ + ": THE CERTIFICATE HAS CHANGED: it is " + fingerprint + ", and " +
           known_.path() + " has " + **known +
           "; either the server made a new one, or somebody else answers in its place. Compare it "
           "with what footing-ctl trust prints on the server; if it is the same, run: footing-ctl "
           "trust tls:" +
           server_ + " " + fingerprint;
  }
  is_new_ = true;
  return "";
}

std::string ServerTrust::OnProved(const std::string& fingerprint) {
  if (!is_new_) return "";
  // Who cannot remember it would trust anybody, each time.
  if (const auto added = known_.Add(server_, fingerprint); !added) {
    return "not connected to tls:" + server_ + ": its certificate " + fingerprint +
           " cannot be remembered: " + added.error().message;
  }
  is_new_ = false;
  log::Warning("trusting tls:" + server_ + " from now on: its certificate is " + fingerprint +
               "; compare it with what footing-ctl trust prints on the server");
  return "";
}

std::string KnownName(const Address& address) { return address.Text().substr(sizeof("tls:") - 1); }

namespace {

/// Keeps the context of a loop's clients.
class ClientTls : public boost::asio::execution_context::service {
 public:
  using key_type = ClientTls;
  inline static boost::asio::execution_context::id id;

  explicit ClientTls(boost::asio::execution_context& owner) : service(owner) {}

  std::optional<tls::Context> context;
  bool shows_own = false;  ///< The user's own certificate.

 private:
  void shutdown() override {}
};

Result<tls::Context> NewClientContext(const std::string& path, bool shows_own) {
  if (!shows_own) return tls::Context::ForClient(nullptr);
  const auto own = tls::Identity::Load(path);
  if (!own) return own.error();
  return tls::Context::ForClient(&*own);
}

}  // namespace

Result<tls::Context> ClientContext(boost::asio::io_context& io) {
  auto& kept = boost::asio::use_service<ClientTls>(io);
  const std::string path = tls::ClientIdentityFile();
  const bool shows_own = !path.empty() && access(path.c_str(), F_OK) == 0;
  // A certificate that was made while this client ran is shown from the next connection on.
  if (!kept.context || (shows_own && !kept.shows_own)) {
    auto made = NewClientContext(path, shows_own);
    if (!made) return made;
    kept.context = std::move(made).value();
    kept.shows_own = shows_own;
  }
  return *kept.context;
}

}  // namespace footing::transport
