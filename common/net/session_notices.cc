#include <string>

#include "common/runtime/clock.h"
#include "common/net/session.h"
#include "common/base/time.h"
#include "common/base/units.h"

/// The part of Session that says what slows it, and what all sessions share.
namespace footing::transport {

std::int64_t Shared::NowNs() const {
  return options.now_ns ? options.now_ns() : clock::MonotonicNs();
}

void Shared::SayOverload(const OverloadLine& line) {
  if (handlers.on_overload && overload_lines.Take(NowNs())) handlers.on_overload(line);
}

void Shared::SayDenied(const std::string& host, Lack lack, const std::string& why) {
  ++statistics.denied;
  TokenBucket& lines = denied_lines.try_emplace(lack, 0.1, 1).first->second;
  if (!handlers.on_overload || !lines.Take(NowNs())) return;
  handlers.on_overload({"refused a client from " + host + ": " + why + " (" +
                        std::to_string(statistics.denied) + " since start)"});
}

void Shared::SayRefused(v1::Refused::Reason reason, const Peer& peer, const std::string& why) {
  TokenBucket& lines = refused_lines.try_emplace(reason, 0.1, 1).first->second;
  if (!handlers.on_overload || !lines.Take(NowNs())) return;
  const std::string who = peer.known ? "of user " + std::to_string(peer.user) : "from " + peer.host;
  handlers.on_overload({"refused a client " + who + ": " + why + " (" +
                        std::to_string(statistics.refused) + " since start)"});
}

void Session::SayEnded(const std::string& why) {
  if (!shared_.handlers.on_overload || !shared_.ended_lines.Take(shared_.NowNs())) return;
  shared_.handlers.on_overload(
      {"session " + std::to_string(info_.session) + " (" + info_.client_name + ") is ended: " + why,
       info_.session});
}

void Session::OnSlowed(double wait_s) {
  ++record_.slowed;
  record_.slowed_until_ns = shared_.NowNs() + SecondsToNanoseconds(wait_s);
  ++shared_.statistics.slowed;
  const std::string name = info_.client_name.empty() ? "" : " (" + info_.client_name + ")";
  shared_.SayOverload({"session " + std::to_string(info_.session) + name + " sends more than " +
                           std::to_string(static_cast<int>(messages_per_s_)) +
                           " messages a second and is slowed",
                       info_.session});
  if (!welcomed() || !slowed_notices_.Take(shared_.NowNs())) return;
  Notify(v1::Notice::KIND_SLOWED,
         "this client exceeds the server's rate limit; its messages are delayed", record_.slowed);
}

bool Session::SlowedLately(std::int64_t now_ns) const {
  const std::int64_t until_ns = record_.slowed_until_ns;
  return until_ns != 0 && now_ns - until_ns < kNanosecondsPerSecond;
}

void Session::Notify(v1::Notice::Kind kind, const std::string& text, std::uint64_t count) {
  if (!welcomed() || !connection_.open()) return;
  v1::Envelope message;
  message.mutable_notice()->set_kind(kind);
  message.mutable_notice()->set_text(text);
  message.mutable_notice()->set_count(count);
  Send(message);
}

}  // namespace footing::transport
