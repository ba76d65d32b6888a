#include <algorithm>
#include <boost/asio/post.hpp>
#include <string>
#include <utility>

#include "common/net/framing.h"
#include "common/net/session.h"
#include "common/net/tick_writer.h"
#include "common/base/units.h"

/// The half of Session that streams: subscription, live ticks, resume and refill.
namespace footing::transport {
namespace {

/// Unanswered requests to refill; each is a few bytes, but there must be an end.
constexpr std::size_t kMaxRefills = 16;
/// In messages: a snapshot is made and sent for it.
constexpr double kSubscribeCost = 20;
/// In messages, of a tick out of the ring: the whole ring of 3000 is within a session's burst.
constexpr double kReplayCost = 0.02;
constexpr int kReplayTicksInATurn = 32;

}  // namespace

std::uint64_t Session::FirstSequence(const v1::Subscribe& wish) const {
  const std::uint64_t next = shared_.publication.last_sequence() + 1;
  const bool resumes = wish.has_from_sequence() && wish.from_epoch() == shared_.epoch;
  if (!resumes || wish.from_sequence() >= next) return next;
  const TickRing& ring = shared_.publication.ring();
  const std::uint64_t oldest = ring.empty() ? next : ring.first();
  return std::max(wish.from_sequence(), oldest);
}

void Session::OnSubscribe(const v1::Subscribe& wish) {
  connection_.Charge(kSubscribeCost - 1);
  EffectiveSubscription settled = Settle(wish, shared_.options);
  const std::uint64_t first = FirstSequence(wish);
  const std::uint64_t next = shared_.publication.last_sequence() + 1;
  settled.answer.set_first_sequence(first);
  v1::Envelope message;
  *message.mutable_subscribed() = settled.answer;
  Send(message);

  record_.ticks_dropped += queue_.dropped_ticks();
  subscription_ = std::move(settled.subscription);
  queue_ = TickQueue(subscription_.rule, subscription_.queue_ticks, shared_.publication.retained());
  decimator_.emplace(subscription_.max_hz, SecondsToNanoseconds(1 / shared_.options.tick_rate_hz));
  replay_.refills.clear();
  replay_.catch_up = first < next ? first : 0;
  SendSnapshot(first - 1);
  if (wish.has_from_sequence()) {
    if (wish.from_epoch() != shared_.epoch) {
      SendGap(wish.from_sequence(), 0, v1::Gap::REASON_NEW_EPOCH);
    } else if (wish.from_sequence() != 0 && wish.from_sequence() < first) {
      SendGap(wish.from_sequence(), first - 1, v1::Gap::REASON_RING_PASSED);
    }
  }
  phase_ = Phase::kSubscribed;
  connection_.Wake();
}

void Session::SendSnapshot(std::uint64_t sequence) {
  const SharedTick tick = shared_.publication.Snapshot(sequence, shared_.NowNs());
  std::string fields;
  for (const Slice& slice : tick->slices) {
    if (subscription_.fields.count(slice.field) == 0) continue;
    fields.append(tick->bytes, slice.begin, slice.size);
  }
  TickHead head;
  head.epoch = shared_.epoch;
  head.sequence = tick->sequence;
  head.host_ns = tick->host_ns;
  head.snapshot = true;
  char bytes[kMaxTickHeadBytes];
  const std::size_t head_bytes = EncodeTickHead(head, fields.size(), bytes);
  fields.insert(0, bytes + kLengthBytes, head_bytes - kLengthBytes);
  SendPayload(fields);
}

void Session::SendGap(std::uint64_t from, std::uint64_t to, v1::Gap::Reason reason) {
  v1::Envelope message;
  message.mutable_gap()->set_from_sequence(from);
  message.mutable_gap()->set_to_sequence(to);
  message.mutable_gap()->set_reason(reason);
  Send(message);
}

void Session::OnRefill(const v1::Refill& wish) {
  if (phase_ != Phase::kSubscribed) return BadMessage("Refill came before Subscribe");
  const std::uint64_t last = std::min(wish.to_sequence(), shared_.publication.last_sequence());
  const std::uint64_t first = std::max<std::uint64_t>(wish.from_sequence(), 1);
  if (first > last) return SayNothingToRefill(wish);
  if (replay_.refills.size() >= kMaxRefills) {
    return End("this client asks for missing ticks faster than it reads them: " +
               std::to_string(kMaxRefills) +
               " Refills wait; send the next one after the ticks of "
               "an earlier one");
  }
  replay_.refills.push_back({first, last});
  JoinReplays();
}

void Session::SayNothingToRefill(const v1::Refill& wish) {
  const std::string from = std::to_string(wish.from_sequence());
  Notify(v1::Notice::KIND_NOTHING_TO_REFILL,
         wish.from_sequence() > wish.to_sequence()
             ? "Refill: from_sequence " + from + " is above to_sequence " +
                   std::to_string(wish.to_sequence())
             : "Refill: tick " + from + " is not published yet; the newest is " +
                   std::to_string(shared_.publication.last_sequence()),
         wish.from_sequence());
}

void Session::Offer(const SharedTick& tick) {
  if (phase_ != Phase::kSubscribed || !connection_.open()) return;
  if (replay_.catch_up != 0) return JoinReplays();  // It will come out of the ring.
  if (!Takes(*tick)) {
    queue_.Skip(tick);
    return;
  }
  const std::uint64_t dropped_before = queue_.dropped_ticks();
  if (!queue_.Push(tick)) {
    return End("this client reads too slowly for the policy reliable: " +
               std::to_string(subscription_.queue_ticks) +
               " ticks wait; resume from the last sequence received, or use drop_oldest");
  }
  shared_.statistics.ticks_dropped += queue_.dropped_ticks() - dropped_before;
  connection_.Wake();
}

/// For max_hz; the one behind a hole always comes, since the Gap comes with it.
bool Session::Takes(const Tick& tick) {
  const bool due = decimator_->Take(tick.host_ns);
  return due || tick.missing_from != 0;
}

TickHead Session::Head(bool refilled) const {
  TickHead head;
  head.epoch = shared_.epoch;
  head.refilled = refilled;
  return head;
}

void Session::AddGap(std::uint64_t from, std::uint64_t to, v1::Gap::Reason reason,
                     WriteBatch& batch) {
  v1::Envelope message;
  message.mutable_gap()->set_from_sequence(from);
  message.mutable_gap()->set_to_sequence(to);
  message.mutable_gap()->set_reason(reason);
  batch.AddOwned(Frame(message.SerializeAsString()));
}

/// Of the hole in front of a tick, what is not before `from`: the rest is known already.
void Session::AddMissing(const Tick& tick, std::uint64_t from, WriteBatch& batch) {
  from = std::max(from, tick.missing_from);
  if (tick.missing_from == 0 || from >= tick.sequence) return;
  AddGap(from, tick.sequence - 1, v1::Gap::REASON_UNSPECIFIED, batch);
}

void Session::Fill(WriteBatch& batch) {
  // A tick and a Gap in front of it.
  while (batch.free_buffers() > kBuffersPerTick) {
    if (FillLive(batch) || FillFromRing(batch)) continue;
    if (replay_.wanted()) return JoinReplays();
    if (!record_.drain_reason.empty() && batch.empty()) EndLater();
    return;
  }
}

/// In turns with all other sessions, since the ring has far more ticks than the present.
void Session::JoinReplays() {
  if (replay_.allowance > 0 || std::exchange(replay_.in_line, true)) return;
  shared_.replays->Add([weak = weak_from_this()] {
    const auto self = weak.lock();
    if (!self) return false;
    self->replay_.in_line = false;
    self->replay_.allowance = kReplayTicksInATurn;
    self->connection_.Wake();
    return false;
  });
}

bool Session::FillFromRing(WriteBatch& batch) {
  if (replay_.allowance == 0 || !replay_.wanted()) return false;
  --replay_.allowance;
  return FillCatchUp(batch) || FillRefill(batch);
}

void Session::Drain(const std::string& reason) {
  if (phase_ != Phase::kSubscribed || !connection_.open()) return End(reason);
  record_.drain_reason = reason;
  connection_.Wake();
}

/// Not from within the filling of a batch.
void Session::EndLater() {
  boost::asio::post(connection_.executor(), [weak = weak_from_this()] {
    if (const auto self = weak.lock()) self->End(self->record_.drain_reason);
  });
}

bool Session::FillLive(WriteBatch& batch) {
  TickQueue::Entry entry;
  if (!queue_.Pop(entry)) return false;
  const std::uint64_t missing = entry.tick->missing_from;
  if (const auto dropped = queue_.TakeDropped()) {
    const std::uint64_t to = missing != 0 ? entry.tick->sequence - 1 : dropped->to;
    AddGap(dropped->from, to, v1::Gap::REASON_QUEUE_FULL, batch);
  } else {
    AddMissing(*entry.tick, 0, batch);
  }
  AddTick(entry, subscription_, Head(false), batch);
  ++record_.ticks_sent;
  return true;
}

bool Session::FillCatchUp(WriteBatch& batch) {
  if (replay_.catch_up == 0) return false;
  const TickRing& ring = shared_.publication.ring();
  if (replay_.catch_up > ring.last()) {
    replay_.catch_up = 0;
    return false;
  }
  if (replay_.catch_up < ring.first()) {  // It read so slowly that the ring went past it.
    AddGap(replay_.catch_up, ring.first() - 1, v1::Gap::REASON_RING_PASSED, batch);
    replay_.catch_up = ring.first();
    return true;
  }
  const SharedTick& tick = *ring.AtOrAfter(replay_.catch_up);
  const std::uint64_t from = std::exchange(replay_.catch_up, tick->sequence + 1);
  connection_.Charge(kReplayCost);
  if (Takes(*tick)) {
    AddMissing(*tick, from, batch);
    AddTick({tick, {}}, subscription_, Head(true), batch);
    ++record_.ticks_sent;
  } else {
    queue_.Skip(tick);
  }
  return true;
}

bool Session::FillRefill(WriteBatch& batch) {
  if (replay_.refills.empty()) return false;
  Range& range = replay_.refills.front();
  const TickRing& ring = shared_.publication.ring();
  if (range.next < ring.first()) {
    const std::uint64_t gone = std::min(range.last, ring.first() - 1);
    AddGap(range.next, gone, v1::Gap::REASON_RING_PASSED, batch);
    range.next = gone + 1;
  } else {
    const SharedTick* tick = ring.AtOrAfter(range.next);
    range.next = range.last + 1;
    if (tick != nullptr && (*tick)->sequence <= range.last) {
      connection_.Charge(kReplayCost);
      AddTick({*tick, {}}, subscription_, Head(true), batch);
      ++record_.ticks_sent;
      range.next = (*tick)->sequence + 1;
    }
  }
  if (range.next > range.last) replay_.refills.pop_front();
  return true;
}

}  // namespace footing::transport
