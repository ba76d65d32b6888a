#include "clients/relay/nats_link.h"

#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <optional>
#include <utility>
#include <vector>

#include <mosquitto.h>
#include <unistd.h>
#include <boost/asio/buffer.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/write.hpp>

#include "common/base/units.h"
#include "common/net/client.h"
#include "common/net/socket.h"
#include "common/runtime/clock.h"
#include "common/runtime/timer.h"

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
        redial_(io, options_.backoff_min_s, options_.backoff_max_s),
        pulse_(io) {
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
    redial_.cancel();
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
    std::string why;  ///< Last error that the server reported.
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
    redial_.Reset();
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
    pulse_.After(options_.ping_interval_s, [this] {
      const auto self = shared_from_this();  // A handler may let the link go.
      if (connection_) OnPulse();
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
    redial_.Later([this] {
      const auto self = shared_from_this();  // A handler may let the link go.
      if (started_) Dial();
    });
    handlers_.on_down(why);
  }

  boost::asio::io_context& io_;
  NatsOptions options_;
  NatsLinkHandlers handlers_;
  nats::Handlers parsed_;
  transport::Redial redial_;
  timer::Timer pulse_;
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

namespace {

constexpr int kKeepAliveS = 5;
constexpr double kBackoffMinS = 0.1, kBackoffMaxS = 1;
constexpr auto kPatience = std::chrono::seconds(5);

}  // namespace

/// The library's thread hands everything over to the io_context: state is used on that thread only.
class MqttLink::Implementation : public std::enable_shared_from_this<Implementation> {
 public:
  Implementation(boost::asio::io_context& io, MqttOptions options, MqttLinkHandlers handlers)
      : io_(io),
        options_(std::move(options)),
        handlers_(std::move(handlers)),
        patience_(io),
        redial_(io, kBackoffMinS, kBackoffMaxS) {
    mosquitto_lib_init();
  }
  ~Implementation() { mosquitto_lib_cleanup(); }

  Result<void> Start() {
    if (!options_.ca_file.empty() && access(options_.ca_file.c_str(), R_OK) != 0) {
      return Failure(options_.ca_file + ": " + std::strerror(errno));
    }
    started_ = true;
    Connect();
    return {};
  }

  void Stop() {
    started_ = false;
    patience_.cancel();
    redial_.cancel();
    LetGo();
  }

  bool Publish(const std::string& topic, const std::string& payload, bool retain) {
    if (!up_) {
      if (was_up_ && !retain) ++dropped_;  // Retained topics are sent again.
      return false;
    }
    const bool sent = in_flight_ < options_.max_in_flight &&
                      mosquitto_publish(client_->mosquitto, nullptr, topic.c_str(),
                                        static_cast<int>(payload.size()), payload.data(), 0,
                                        retain) == MOSQ_ERR_SUCCESS;
    if (sent) ++in_flight_;
    if (!sent) ++dropped_;
    return sent;
  }

  bool up() const { return up_; }
  std::uint64_t dropped() const { return dropped_; }

 private:
  /// One try, from the dial until it breaks. The library's thread has its address.
  struct Client {
    Client(Implementation& with, std::uint64_t of)
        : owner(with.weak_from_this()), io(with.io_), attempt(of) {}
    ~Client() {
      if (mosquitto == nullptr) return;
      mosquitto_disconnect(mosquitto);
      mosquitto_loop_stop(mosquitto, true);  // Waits for its thread.
      mosquitto_destroy(mosquitto);
    }
    Client(const Client&) = delete;
    Client& operator=(const Client&) = delete;

    /// On the library's thread.
    template <typename Work>
    void Hand(Work work) {
      boost::asio::post(io, [weak = owner, of = attempt, work] {
        const auto self = weak.lock();
        if (self && self->client_ && self->client_->attempt == of) work(*self);
      });
    }

    std::weak_ptr<Implementation> owner;
    boost::asio::io_context& io;
    std::uint64_t attempt;
    ::mosquitto* mosquitto = nullptr;
  };

  void Connect() {
    client_ = std::make_unique<Client>(*this, ++attempt_);
    const int code = Dial(*client_);
    if (code != MOSQ_ERR_SUCCESS) {
      const int number = errno;
      return OnDown(code == MOSQ_ERR_ERRNO ? std::strerror(number) : mosquitto_strerror(code));
    }
    patience_.After(kPatience, [this] {
      const auto self = shared_from_this();  // A handler may let the link go.
      if (!up_) OnDown("it does not answer");
    });
  }

  int Dial(Client& client) {
    client.mosquitto = mosquitto_new(options_.client_id.c_str(), true, &client);
    if (client.mosquitto == nullptr) return MOSQ_ERR_NOMEM;
    mosquitto_connect_callback_set(client.mosquitto, [](::mosquitto*, void* at, int code) {
      static_cast<Client*>(at)->Hand([code](Implementation& self) { self.OnConnect(code); });
    });
    mosquitto_disconnect_callback_set(client.mosquitto, [](::mosquitto*, void* at, int code) {
      static_cast<Client*>(at)->Hand(
          [code](Implementation& self) { self.OnDown(mosquitto_strerror(code)); });
    });
    mosquitto_publish_callback_set(client.mosquitto, [](::mosquitto*, void* at, int) {
      static_cast<Client*>(at)->Hand([](Implementation& self) { --self.in_flight_; });
    });
    const nats::Login& login = options_.login;
    const std::string& user = login.user.empty() ? login.token : login.user;
    int code = MOSQ_ERR_SUCCESS;
    if (!user.empty()) {
      code = mosquitto_username_pw_set(client.mosquitto, user.c_str(),
                                       login.user.empty() ? nullptr : login.password.c_str());
    }
    if (code == MOSQ_ERR_SUCCESS && !options_.ca_file.empty()) {
      code = mosquitto_tls_set(client.mosquitto, options_.ca_file.c_str(), nullptr, nullptr,
                               nullptr, nullptr);
    }
    if (code != MOSQ_ERR_SUCCESS) return code;
    code = mosquitto_connect_async(client.mosquitto, options_.host.c_str(), options_.port,
                                   kKeepAliveS);
    return code == MOSQ_ERR_SUCCESS ? mosquitto_loop_start(client.mosquitto) : code;
  }

  void LetGo() {
    up_ = false;
    in_flight_ = 0;
    client_.reset();
  }

  void OnConnect(int code) {
    if (code != 0) return OnDown(mosquitto_connack_string(code));
    patience_.cancel();
    up_ = was_up_ = true;
    redial_.Reset();
    handlers_.on_up();
  }

  void OnDown(const std::string& why) {
    LetGo();
    if (!started_) return;
    patience_.cancel();
    redial_.Later([this] {
      const auto self = shared_from_this();  // A handler may let the link go.
      if (started_) Connect();
    });
    handlers_.on_down(options_.host + ":" + std::to_string(options_.port) + ": " + why);
  }

  boost::asio::io_context& io_;
  MqttOptions options_;
  MqttLinkHandlers handlers_;
  timer::Timer patience_;  ///< Until this try has failed.
  transport::Redial redial_;
  bool started_ = false;
  std::uint64_t attempt_ = 0;
  std::unique_ptr<Client> client_;
  bool up_ = false;
  bool was_up_ = false;
  int in_flight_ = 0;
  std::uint64_t dropped_ = 0;
};

MqttLink::MqttLink(boost::asio::io_context& io, MqttOptions options, MqttLinkHandlers handlers)
    : implementation_(
          std::make_shared<Implementation>(io, std::move(options), std::move(handlers))) {}
MqttLink::~MqttLink() { implementation_->Stop(); }

Result<void> MqttLink::Start() { return implementation_->Start(); }
void MqttLink::Stop() { implementation_->Stop(); }
bool MqttLink::Publish(const std::string& topic, const std::string& payload, bool retain) {
  return implementation_->Publish(topic, payload, retain);
}
bool MqttLink::up() const { return implementation_->up(); }
std::uint64_t MqttLink::dropped() const { return implementation_->dropped(); }

}  // namespace footing::relay
