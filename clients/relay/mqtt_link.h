#pragma once

#include <boost/asio/io_context.hpp>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "clients/relay/requests.h"
#include "common/base/result.h"

namespace footing::relay {

struct MqttOptions {
  std::string host;
  int port = 1883;
  std::string ca_file;  ///< Certificates that the broker's must be signed by; empty: no TLS.
  std::string client_id;
  nats::Login login;         ///< User and password; a token is the user's name.
  int max_in_flight = 1024;  ///< Messages that the library may hold; further ones are dropped.
};

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
