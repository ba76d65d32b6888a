#include "common/net/handshake.h"

#include <algorithm>
#include <cmath>

namespace footing::transport {
namespace {

constexpr std::uint32_t kDefaultQueueTicks = 256;
constexpr double kSlowestHz = 0.001;

QueueRule RuleOf(v1::QueuePolicy policy) {
  switch (policy) {
    case v1::QUEUE_POLICY_LATEST:
      return QueueRule::kLatest;
    case v1::QUEUE_POLICY_RELIABLE:
      return QueueRule::kReliable;
    default:  // Unspecified, or one of a later minor version.
      return QueueRule::kDropOldest;
  }
}

void SettleChannels(const v1::Subscribe& wish, const ServerOptions& options,
                    EffectiveSubscription& settled) {
  const std::set<std::string> wished(wish.channels().begin(), wish.channels().end());
  std::set<std::string> unknown = wished;
  for (const Channel& channel : options.channels) {
    unknown.erase(channel.name);
    if (!wished.empty() && wished.count(channel.name) == 0) continue;
    settled.subscription.fields.insert(channel.field);
    settled.answer.add_channels(channel.name);
  }
  settled.subscription.all = settled.subscription.fields.size() == options.channels.size();
  for (const std::string& name : unknown) settled.answer.add_unknown_channels(name);
}

}  // namespace

std::string RoleName(v1::Role role) {
  switch (role) {
    case v1::ROLE_VIEW:
      return "view";
    case v1::ROLE_LOG:
      return "log";
    case v1::ROLE_CONTROL:
      return "control";
    case v1::ROLE_ADMIN:
      return "admin";
    default:
      return std::to_string(static_cast<int>(role));
  }
}

v1::Refused Refuse(v1::Refused::Reason reason, const std::string& message) {
  v1::Refused refused;
  refused.set_reason(reason);
  refused.set_message(message);
  return refused;
}

v1::Welcome MakeWelcome(const ServerOptions& options, std::uint64_t epoch, v1::Role role) {
  v1::Welcome welcome;
  welcome.set_server_id(options.server_id);
  welcome.set_version(options.version);
  welcome.set_epoch(epoch);
  welcome.set_protocol_major(kProtocolMajor);
  welcome.set_protocol_minor(kProtocolMinor);
  welcome.set_granted_role(role);
  for (const auto& capability : options.capabilities) welcome.add_capabilities(capability);
  for (const auto& channel : options.channels) welcome.add_channels(channel.name);
  v1::Limits& limits = *welcome.mutable_limits();
  limits.set_max_message_in_bytes(options.max_message_in_bytes);
  limits.set_max_message_out_bytes(options.max_message_out_bytes);
  limits.set_max_queue_ticks(options.max_queue_ticks);
  limits.set_ring_s(options.ring_s);
  limits.set_tick_rate_hz(options.tick_rate_hz);
  limits.set_max_messages_per_s(options.sessions.session_messages_per_s);
  limits.set_max_message_burst(static_cast<std::uint32_t>(options.sessions.Input().message_burst));
  return welcome;
}

EffectiveSubscription Settle(const v1::Subscribe& wish, const ServerOptions& options) {
  EffectiveSubscription settled;
  SettleChannels(wish, options, settled);
  Subscription& subscription = settled.subscription;
  const bool slower = wish.max_hz() > 0 && wish.max_hz() < options.tick_rate_hz;
  subscription.max_hz = slower ? std::max(wish.max_hz(), kSlowestHz) : 0;
  subscription.rule = RuleOf(wish.policy());
  const std::uint32_t queue = wish.queue_ticks() == 0 ? kDefaultQueueTicks : wish.queue_ticks();
  subscription.queue_ticks =
      subscription.rule == QueueRule::kLatest ? 1 : std::min(queue, options.max_queue_ticks);
  subscription.max_channel_bytes = options.max_message_out_bytes - kMaxTickHeadBytes;
  settled.answer.set_max_hz(slower ? subscription.max_hz : options.tick_rate_hz);
  settled.answer.set_policy(static_cast<v1::QueuePolicy>(subscription.rule));
  settled.answer.set_queue_ticks(static_cast<std::uint32_t>(subscription.queue_ticks));
  return settled;
}

}  // namespace footing::transport
