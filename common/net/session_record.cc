#include "common/net/session_record.h"

#include <algorithm>

#include "common/net/handshake.h"
#include "common/net/session.h"
#include "common/base/units.h"
#include "common/wire/wire.h"

namespace footing::transport {
namespace {

const char* NameOf(QueueRule rule) {
  switch (rule) {
    case QueueRule::kLatest:
      return "latest";
    case QueueRule::kDropOldest:
      return "drop_oldest";
    case QueueRule::kReliable:
      return "reliable";
  }
  return "";
}

}  // namespace

void SessionRecord::TakePong(const v1::Pong& pong, std::int64_t arrived_ns) {
  const bool answers = ping.unanswered && pong.id() == ping.id;
  ping.unanswered = false;
  if (answers) clock.Add({ping.sent_ns, pong.t1_ns(), pong.t2_ns(), arrived_ns});
}

stream::SessionStats Session::Stats() const {
  const std::int64_t now_ns = shared_.NowNs();
  stream::SessionStats stats;
  stats.session = info_.session;
  stats.client_name = info_.client_name;
  stats.role = RoleName(info_.role);
  stats.local = peer_.known;
  stats.connected_s = NanosecondsToSeconds(now_ns - record_.began_ns);
  stats.ticks_sent = record_.ticks_sent;
  stats.ticks_dropped = record_.ticks_dropped + queue_.dropped_ticks();
  stats.slowed = record_.slowed;
  const OffsetEstimate clock = record_.clock.estimate();
  stats.clock_valid = clock.valid;
  stats.clock_offset_s = NanosecondsToSeconds(clock.offset_ns);
  stats.clock_uncertainty_s = NanosecondsToSeconds(clock.uncertainty_ns);
  if (phase_ != Phase::kSubscribed) return stats;
  stats.policy = NameOf(subscription_.rule);
  stats.queue_capacity = static_cast<std::uint32_t>(subscription_.queue_ticks);
  std::uint64_t waiting = queue_.size();
  const Tick* oldest = queue_.oldest();
  if (replay_.catch_up != 0) {
    const TickRing& ring = shared_.publication.ring();
    const std::uint64_t next =
        ring.empty() ? replay_.catch_up : std::max(replay_.catch_up, ring.first());
    const SharedTick* tick = ring.AtOrAfter(next);
    if (tick != nullptr) {
      oldest = tick->get();
      waiting = ring.CountFrom(next);
    }
  }
  stats.queue_ticks = static_cast<std::uint32_t>(waiting);
  if (oldest != nullptr) stats.lag_s = NanosecondsToSeconds(now_ns - oldest->host_ns);
  return stats;
}

v1::ConnectedSession Session::Describe() const {
  v1::ConnectedSession described;
  *described.mutable_stats() = wire::ToProto(Stats());
  if (peer_.known) described.set_user(peer_.user);
  described.set_host(peer_.host);
  described.set_granted_by(Name(admitted_.grant));
  described.set_certificate(admitted_.claim.certificate);
  return described;
}

}  // namespace footing::transport
