#pragma once

#include <cstdint>
#include <set>
#include <string>

#include "common/net/server.h"
#include "common/net/tick_queue.h"
#include "footing/v1/session.pb.h"

/// The answers to Hello and Subscribe, as functions of what was asked; admission.h decides who gets
/// them.
namespace footing::transport {

inline constexpr std::uint32_t kProtocolMajor = 1;
inline constexpr std::uint32_t kProtocolMinor = 0;

/// As a person reads it; the number of one that this version does not know.
std::string RoleName(v1::Role role);

v1::Refused Refuse(v1::Refused::Reason reason, const std::string& message);

/// A Welcome but for its stamps.
v1::Welcome MakeWelcome(const ServerOptions& options, std::uint64_t epoch, v1::Role role);

/// What a session gets, after the server's limits.
struct Subscription {
  std::set<std::uint32_t> fields;
  bool all = false;   ///< Every channel: the tick's bytes go out as one piece.
  double max_hz = 0;  ///< 0: every tick.
  QueueRule rule = QueueRule::kDropOldest;
  std::size_t queue_ticks = 1;
  std::size_t max_channel_bytes = 0;  ///< Of one tick, with what it carries along.
};

/// The effective subscription and the answer that says so (but for first_sequence).
struct EffectiveSubscription {
  Subscription subscription;
  v1::Subscribed answer;
};
EffectiveSubscription Settle(const v1::Subscribe& wish, const ServerOptions& options);

}  // namespace footing::transport
