#include "common/net/client.h"

#include <chrono>
#include <optional>
#include <random>
#include <utility>

#include "common/runtime/clock.h"
#include "common/runtime/timer.h"
#include "common/net/backoff.h"
#include "common/net/client_messages.h"
#include "common/net/clock_probes.h"
#include "common/net/framed_connection.h"
#include "common/net/message_parser.h"
#include "common/net/pending_commands.h"
#include "common/net/server_position.h"
#include "common/base/time.h"
#include "common/base/units.h"

namespace footing::transport {
class Client::Implementation : public std::enable_shared_from_this<Implementation> {
 public:
  Implementation(boost::asio::io_context& io, ClientOptions options, ClientHandlers handlers)
      : io_(io),
        options_(std::move(options)),
        handlers_(std::move(handlers)),
        retry_(io),
        pulse_(io),
        backoff_(options_.backoff_min_s, options_.backoff_max_s),
        random_(std::random_device()()) {}

  void Start() {
    if (started_) return;
    started_ = true;
    Connect();
  }

  void Stop() {
    started_ = false;
    subscribed_ = false;
    ++attempt_;  // A dial under way is forgotten.
    retry_.cancel();
    pulse_.cancel();
    connection_.reset();
    wish_.reset();
    why_ = "the client was stopped";
    commands_.Fail(why_);
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

  static std::chrono::nanoseconds Duration(double seconds) {
    return std::chrono::nanoseconds(SecondsToNanoseconds(seconds));
  }

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
    FramedLimits limits{.max_in_bytes = options_.max_message_bytes};
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
      case v1::Envelope::kRefused:
        close_ = {true, options_.address.Text() + " refused: " + message.refused().message()};
        return Call(handlers_.on_refused, message.refused());
      case v1::Envelope::kGoodbye:
        close_.text = message.goodbye().reason();
        return;
      default:  // Of a later minor version.
        return;
    }
  }

  void OnWelcome(const v1::Welcome& welcome) {
    probes_.OnWelcome(welcome.epoch() != server_.epoch);  // Perhaps another host.
    server_.name = welcome.server_id() + " " + welcome.version();
    wish_ = MakeSubscribe(options_, welcome.epoch(), server_.last_epoch, server_.last_sequence);
    server_.epoch = welcome.epoch();
    SendPing();
    Call(handlers_.on_welcome, welcome);
  }

  void Subscribe() { SendMessage(*std::exchange(wish_, std::nullopt)); }

  void OnSubscribed() {
    subscribed_ = true;
    backoff_.Reset();
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
    pulse_.expires_after(Duration(options_.ping_interval_s));
    pulse_.async_wait([weak = weak_from_this()](const boost::system::error_code& error) {
      const auto self = weak.lock();
      if (!error && self && self->connection_) self->OnPulse();
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
    const double random = std::uniform_real_distribution<double>(0, 1)(random_);
    const double wait_s = state == LinkState::kRefused ? options_.refused_wait_s * (1 + random) / 2
                                                       : backoff_.Next(random);
    retry_.expires_after(Duration(wait_s));
    retry_.async_wait([weak = weak_from_this()](const boost::system::error_code& error) {
      const auto self = weak.lock();
      if (!error && self && self->started_) self->Connect();
    });
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
  timer::Timer retry_;
  timer::Timer pulse_;
  Backoff backoff_;
  std::mt19937_64 random_;
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
void Client::Refill(std::uint64_t from_sequence, std::uint64_t to_sequence) {
  implementation_->Refill(from_sequence, to_sequence);
}
LinkState Client::state() const { return implementation_->state(); }
ClockOffset Client::clock() const { return implementation_->clock(); }

}  // namespace footing::transport
