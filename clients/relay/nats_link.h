#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include <boost/asio/io_context.hpp>

#include "clients/relay/nats_protocol.h"
#include "common/base/result.h"
#include "common/net/address.h"

namespace footing::relay {

/// Options of a connection to a NATS server.
struct NatsOptions {
  transport::Address address;
  std::string client_name;
  nats::Login login;
  std::size_t max_payload = (1u << 20) + 64;       ///< Limit of a received message.
  std::size_t max_queued_bytes = 8u << 20;         ///< More that waits to be sent is dropped.
  double backoff_min_s = 0.1, backoff_max_s = 1;   ///< Waits between tries.
  double ping_interval_s = 1, dead_after_s = 3.5;  ///< A link on which nothing comes is dropped.
};

/// Callbacks of a connection to a NATS server.
struct NatsLinkHandlers {
  /// The server took us in; subscriptions are made already.
  std::function<void()> on_up;
  std::function<void(const std::string& why)> on_down;
  /// Valid during the call.
  std::function<void(const nats::Message&)> on_message;
};

/// A connection to a NATS server that is made again when it breaks. Everything runs on the
/// io_context's one thread; handlers are never called from within a call to this class.
class NatsLink {
 public:
  NatsLink(boost::asio::io_context& io, NatsOptions options, NatsLinkHandlers handlers);
  ~NatsLink();
  NatsLink(const NatsLink&) = delete;
  NatsLink& operator=(const NatsLink&) = delete;

  void Start();
  void Stop();

  /// Lasts over reconnections.
  void Subscribe(const std::string& subject);
  /// False, and nothing is sent, when the link is down, the server refuses messages as long as
  /// this, or too much waits.
  bool Publish(const std::string& subject, std::string_view payload, const std::string& reply = "");

  bool up() const;
  std::uint64_t dropped() const;  ///< Messages that Publish() refused since the link was up first.

 private:
  class Implementation;
  std::shared_ptr<Implementation> implementation_;
};

/// Options of a connection to an MQTT broker.
struct MqttOptions {
  std::string host;
  int port = 1883;
  std::string ca_file;  ///< Certificates that the broker's must be signed by; empty: no TLS.
  std::string client_id;
  nats::Login login;         ///< User and password; a token is the user's name.
  int max_in_flight = 1024;  ///< Messages that the library may hold; further ones are dropped.
};

/// Callbacks of a connection to an MQTT broker.
struct MqttLinkHandlers {
  std::function<void()> on_up;
  std::function<void(const std::string& why)> on_down;
};

/// A connection to an MQTT broker (3.1.1, QoS 0) that is made again when it breaks. The library
/// works on a thread of its own; handlers are called on the io_context's one thread.
class MqttLink {
 public:
  MqttLink(boost::asio::io_context& io, MqttOptions options, MqttLinkHandlers handlers);
  ~MqttLink();
  MqttLink(const MqttLink&) = delete;
  MqttLink& operator=(const MqttLink&) = delete;

  /// An error when the file of certificates cannot be read.
  Result<void> Start();
  void Stop();

  /// False, and nothing is sent, when the link is down or the broker takes too little. `retain`:
  /// the broker keeps it for those who subscribe later.
  bool Publish(const std::string& topic, const std::string& payload, bool retain);

  bool up() const;
  std::uint64_t dropped() const;  ///< Messages that Publish() refused since the link was up first.

 private:
  class Implementation;
  std::shared_ptr<Implementation> implementation_;
};

}  // namespace footing::relay
