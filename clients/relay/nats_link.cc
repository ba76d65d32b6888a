#include "clients/relay/nats_link.h"

#include <array>
#include <boost/asio/buffer.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/write.hpp>
#include <chrono>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include "common/runtime/clock.h"
#include "common/runtime/timer.h"
#include "common/net/backoff.h"
#include "common/net/socket.h"
#include "common/base/time.h"
#include "common/base/units.h"

namespace footing::relay {
namespace {

constexpr std::size_t kReadBytes = 64 << 10;

}  // namespace

class NatsLink::Implementation : public std::enable_shared_from_this<Implementation> {
 public:
  Implementation(boost::asio::io_context& io, NatsOptions options, NatsLinkHandlers handlers)
      : io_(io),
        options_(std::move(options)),
        handlers_(std::move(handlers)),
        retry_(io),
        pulse_(io),
        backoff_(options_.backoff_min_s, options_.backoff_max_s),
        random_(std::random_device()()) {
    parsed_.on_info = [this](const nats::ServerInfo& info) { OnInfo(info); };
    parsed_.on_message = [this](const nats::Message& message) { handlers_.on_message(message); };
    parsed_.on_ping = [this] { Queue("PONG\r\n"); };
    parsed_.on_pong = [this] { OnPong(); };
    parsed_.on_error = [this](std::string_view text) {
      if (connection_) connection_->why = "the server says: " + std::string(text);
    };
  }

  void Start() {
    if (started_) return;
    started_ = true;
    Dial();
  }

  void Stop() {
    started_ = false;
    ++attempt_;
    retry_.cancel();
    pulse_.cancel();
    if (connection_) connection_->socket.Close();
    connection_.reset();
  }

  void Subscribe(const std::string& subject) {
    subjects_.push_back(subject);
    if (connection_ && connection_->greeted) Queue(nats::Subscribe(subject, subjects_.size()));
  }

  bool Publish(const std::string& subject, std::string_view payload, const std::string& reply) {
    if (!up()) {
      if (was_up_) ++dropped_;
      return false;
    }
    const bool too_long = connection_->max_payload > 0 && payload.size() > connection_->max_payload;
    if (too_long || connection_->queued.size() + payload.size() > options_.max_queued_bytes) {
      ++dropped_;
      return false;
    }
    Queue(nats::Publish(subject, reply, payload));
    return true;
  }

  bool up() const { return connection_ && connection_->up; }
  std::uint64_t dropped() const { return dropped_; }

 private:
  /// One connection, from the dial until it breaks. Its handlers hold it while they run.
  struct Connection {
    Connection(transport::Socket with, std::size_t max_payload)
        : socket(std::move(with)), parser(max_payload) {}

    transport::Socket socket;
    nats::Parser parser;
    std::array<char, kReadBytes> in;
    std::string queued;   ///< Waits behind what is being written.
    std::string writing;  ///< Empty: nothing is.
    std::size_t max_payload = 0;
    bool greeted = false;  ///< Its INFO came, and our subscriptions went.
    bool up = false;
    std::int64_t heard_ns = 0;
    std::string why;  ///< What the server said last that was wrong.
  };

  void Dial() {
    transport::Dial(
        io_, options_.address,
        [weak = weak_from_this(), attempt = ++attempt_](Result<transport::Socket> socket) {
          const auto self = weak.lock();
          if (!self || attempt != self->attempt_) return;
          if (!socket) return self->Retry(socket.error().message);
          self->OnConnected(std::move(*socket));
        });
  }

  void OnConnected(transport::Socket socket) {
    connection_ = std::make_shared<Connection>(std::move(socket), options_.max_payload);
    transport::Prepare(connection_->socket);
    connection_->heard_ns = clock::MonotonicNs();
    Read(connection_);
    ArmPulse();
  }

  void Read(const std::shared_ptr<Connection>& connection) {
    connection->socket.plain().async_read_some(
        boost::asio::buffer(connection->in),
        [weak = weak_from_this(), connection](const boost::system::error_code& error,
                                              std::size_t count) {
          const auto self = weak.lock();
          if (!self || self->connection_ != connection) return;
          if (error) return self->Break(transport::MessageOf(error));
          connection->heard_ns = clock::MonotonicNs();
          const auto taken = connection->parser.Take({connection->in.data(), count}, self->parsed_);
          if (self->connection_ != connection) return;  // A handler stopped us.
          if (!taken) return self->Break(taken.error().message);
          self->Read(connection);
        });
  }

  void OnInfo(const nats::ServerInfo& info) {
    if (!connection_) return;
    const bool first = !std::exchange(connection_->greeted, true);
    connection_->max_payload = info.max_payload > 0 ? info.max_payload : options_.max_payload;
    if (!first) return;  // The cluster changed.
    if (info.tls_required) connection_->why = "it wants TLS, which footing-relay does not speak";
    Queue(nats::Connect(options_.client_name, options_.login));
    for (std::size_t i = 0; i < subjects_.size(); ++i) Queue(nats::Subscribe(subjects_[i], i + 1));
    Queue("PING\r\n");  // Its answer says that we are in.
  }

  void OnPong() {
    if (!connection_ || connection_->up) return;
    connection_->up = was_up_ = true;
    backoff_.Reset();
    handlers_.on_up();
  }

  void Queue(std::string_view bytes) {
    if (!connection_) return;
    connection_->queued.append(bytes);
    if (connection_->writing.empty()) Write(connection_);
  }

  void Write(const std::shared_ptr<Connection>& connection) {
    connection->writing = std::exchange(connection->queued, {});
    if (connection->writing.empty()) return;
    boost::asio::async_write(
        connection->socket.plain(), boost::asio::buffer(connection->writing),
        [weak = weak_from_this(), connection](const boost::system::error_code& error, std::size_t) {
          const auto self = weak.lock();
          if (!self || self->connection_ != connection) return;
          if (error) return self->Break(transport::MessageOf(error));
          connection->writing.clear();
          self->Write(connection);
        });
  }

  void ArmPulse() {
    pulse_.expires_after(std::chrono::nanoseconds(SecondsToNanoseconds(options_.ping_interval_s)));
    pulse_.async_wait([weak = weak_from_this()](const boost::system::error_code& error) {
      const auto self = weak.lock();
      if (!error && self && self->connection_) self->OnPulse();
    });
  }

  void OnPulse() {
    const std::int64_t now_ns = clock::MonotonicNs();
    if (transport::WasLate(pulse_)) connection_->heard_ns = now_ns;  // It was us who stood still.
    const double silent_s = NanosecondsToSeconds(now_ns - connection_->heard_ns);
    if (silent_s > options_.dead_after_s) return Break("it does not answer any more");
    if (connection_->up) Queue("PING\r\n");
    ArmPulse();
  }

  void Break(const std::string& reason) {
    const std::string why = connection_->why.empty() ? reason : connection_->why;
    connection_->socket.Close();
    connection_.reset();
    pulse_.cancel();
    Retry(options_.address.Text() + ": " + why);
  }

  void Retry(const std::string& why) {
    if (!started_) return;
    const double random = std::uniform_real_distribution<double>(0, 1)(random_);
    retry_.expires_after(std::chrono::nanoseconds(SecondsToNanoseconds(backoff_.Next(random))));
    retry_.async_wait([weak = weak_from_this()](const boost::system::error_code& error) {
      const auto self = weak.lock();
      if (!error && self && self->started_) self->Dial();
    });
    handlers_.on_down(why);
  }

  boost::asio::io_context& io_;
  NatsOptions options_;
  NatsLinkHandlers handlers_;
  nats::Handlers parsed_;
  timer::Timer retry_;
  timer::Timer pulse_;
  transport::Backoff backoff_;
  std::mt19937 random_;
  bool started_ = false;
  std::uint64_t attempt_ = 0;
  std::vector<std::string> subjects_;  ///< The subscription's number is its place, from 1.
  std::shared_ptr<Connection> connection_;
  std::uint64_t dropped_ = 0;
  bool was_up_ = false;
};

NatsLink::NatsLink(boost::asio::io_context& io, NatsOptions options, NatsLinkHandlers handlers)
    : implementation_(
          std::make_shared<Implementation>(io, std::move(options), std::move(handlers))) {}
NatsLink::~NatsLink() { implementation_->Stop(); }

void NatsLink::Start() { implementation_->Start(); }
void NatsLink::Stop() { implementation_->Stop(); }
void NatsLink::Subscribe(const std::string& subject) { implementation_->Subscribe(subject); }
bool NatsLink::Publish(const std::string& subject, std::string_view payload,
                       const std::string& reply) {
  return implementation_->Publish(subject, payload, reply);
}
bool NatsLink::up() const { return implementation_->up(); }
std::uint64_t NatsLink::dropped() const { return implementation_->dropped(); }

}  // namespace footing::relay
