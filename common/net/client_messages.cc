#include "common/net/client_messages.h"

#include <cstdlib>
#include <string_view>

#include "common/net/handshake.h"
#include "common/net/run_folder.h"
#include "common/net/socket.h"
#include "common/net/token.h"

namespace footing::transport {
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

}  // namespace footing::transport
