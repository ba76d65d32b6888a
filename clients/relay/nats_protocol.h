#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "common/base/result.h"

/// The text protocol of NATS, client's side: https://docs.nats.io/reference/nats-protocol.
namespace footing::relay::nats {

/// Properties that a server states in INFO.
struct ServerInfo {
  std::string version;
  std::size_t max_payload = 0;  ///< It refuses a longer message; 0: not said.
  bool auth_required = false;
  bool tls_required = false;
};

/// MSG or HMSG; valid during the call that delivers it.
struct Message {
  std::string_view subject;
  std::uint64_t subscription = 0;
  std::string_view reply;  ///< Subject for an answer; empty: none is wanted.
  std::string_view payload;
  bool no_responders = false;  ///< In answer to a request: nobody listens on its subject.
};

/// Callbacks for the messages of a server, one for each verb.
struct Handlers {
  std::function<void(const ServerInfo&)> on_info;
  std::function<void(const Message&)> on_message;
  std::function<void()> on_ping;
  std::function<void()> on_pong;
  std::function<void(std::string_view text)> on_error;  ///< -ERR, without its quotes.
};

/// Splits the bytes that a server sends into its messages, however they are cut. Holds at most one
/// message: a longer line or payload is an error as soon as it is announced.
class Parser {
 public:
  static constexpr std::size_t kMaxLineBytes = 32 << 10;  ///< INFO lists the servers of a cluster.

  explicit Parser(std::size_t max_payload) : max_payload_(max_payload) {}

  /// Calls the handlers for what is complete. After an error the connection is of no more use.
  Result<void> Take(std::string_view bytes, const Handlers& handlers);

  std::size_t buffered() const { return buffer_.size(); }

 private:
  /// A message whose payload is still to come.
  struct Announced {
    std::string subject;
    std::string reply;
    std::uint64_t subscription = 0;
    std::size_t header_bytes = 0;
    std::size_t total_bytes = 0;
  };

  /// Bytes used of the front of `rest`; 0: more must come.
  Result<std::size_t> Step(std::string_view rest, const Handlers& handlers);
  Result<void> OnLine(std::string_view line, const Handlers& handlers);
  Result<void> OnAnnounced(std::string_view words, bool has_header);
  Result<std::size_t> OnPayload(std::string_view rest, const Handlers& handlers);

  std::size_t max_payload_;
  std::string buffer_;
  bool waits_for_payload_ = false;
  Announced announced_;
};

/// Credentials of a NATS client; all empty: none.
struct Login {
  std::string user;
  std::string password;
  std::string token;
};

/// CONNECT line of a client.
std::string Connect(const std::string& client_name, const Login& login);
/// SUB line; `subscription` is the client's number for it.
std::string Subscribe(const std::string& subject, std::uint64_t subscription);
/// PUB line with its payload; `reply` may be empty.
std::string Publish(const std::string& subject, const std::string& reply, std::string_view payload);

/// True for a text that can be one part of a subject, and of a topic of MQTT: 1 to 64 letters,
/// digits, - and _.
bool IsPart(std::string_view text);

}  // namespace footing::relay::nats
