#include "clients/relay/mqtt_link.h"

#include <mosquitto.h>
#include <unistd.h>

#include <boost/asio/post.hpp>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <random>
#include <utility>

#include "common/runtime/timer.h"
#include "common/net/backoff.h"
#include "common/base/units.h"

namespace footing::relay {
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
        timer_(io),
        backoff_(kBackoffMinS, kBackoffMaxS),
        random_(std::random_device()()) {
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
    timer_.cancel();
    LetGo();
  }

  bool Publish(const std::string& topic, const std::string& payload, bool retain) {
    if (!up_) {
      if (was_up_ && !retain) ++dropped_;  // What is retained comes again.
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
    timer_.expires_after(kPatience);
    timer_.async_wait([weak = weak_from_this()](const boost::system::error_code& error) {
      const auto self = weak.lock();
      if (!error && self && !self->up_) self->OnDown("it does not answer");
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
    timer_.cancel();
    up_ = was_up_ = true;
    backoff_.Reset();
    handlers_.on_up();
  }

  void OnDown(const std::string& why) {
    LetGo();
    if (!started_) return;
    const double random = std::uniform_real_distribution<double>(0, 1)(random_);
    timer_.expires_after(std::chrono::nanoseconds(SecondsToNanoseconds(backoff_.Next(random))));
    timer_.async_wait([weak = weak_from_this()](const boost::system::error_code& error) {
      const auto self = weak.lock();
      if (!error && self && self->started_) self->Connect();
    });
    handlers_.on_down(options_.host + ":" + std::to_string(options_.port) + ": " + why);
  }

  boost::asio::io_context& io_;
  MqttOptions options_;
  MqttLinkHandlers handlers_;
  timer::Timer timer_;  ///< Until the next try, or until this one has failed.
  transport::Backoff backoff_;
  std::mt19937 random_;
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
