#include "common/net/tick_queue.h"

#include <algorithm>

namespace footing::transport {
namespace {

void Set(std::vector<RetainedField>& retained, std::uint32_t field, const SharedTick& tick) {
  for (RetainedField& one : retained) {
    if (one.field == field) {
      one.tick = tick;
      return;
    }
  }
  retained.push_back({field, tick});
}

}  // namespace

TickQueue::TickQueue(QueueRule rule, std::size_t capacity, std::set<std::uint32_t> retained)
    : rule_(rule),
      capacity_(rule == QueueRule::kLatest ? 1 : std::max<std::size_t>(1, capacity)),
      retained_(std::move(retained)) {}

void TickQueue::Retain(const SharedTick& tick, std::vector<RetainedField>& retained) const {
  for (const Slice& slice : tick->slices) {
    if (retained_.count(slice.field) > 0) Set(retained, slice.field, tick);
  }
}

void TickQueue::Skip(const SharedTick& tick) { Retain(tick, for_next_); }

bool TickQueue::Push(SharedTick tick) {
  if (entries_.size() >= capacity_) {
    if (rule_ == QueueRule::kReliable) return false;
    Add(std::move(tick));
    DropOldest();
    return true;
  }
  Add(std::move(tick));
  return true;
}

void TickQueue::Add(SharedTick tick) {
  if (entries_.full()) entries_.set_capacity(std::max<std::size_t>(2, 2 * entries_.capacity()));
  entries_.push_back({std::move(tick), std::exchange(for_next_, {})});
}

void TickQueue::DropOldest() {
  Entry oldest = std::move(entries_.front());
  entries_.pop_front();
  const std::uint64_t sequence = oldest.tick->sequence;
  const std::uint64_t missing = oldest.tick->missing_from;
  dropped_ = Dropped{dropped_ ? dropped_->from : missing != 0 ? missing : sequence, sequence};
  ++dropped_ticks_;
  // What the dropped one contained, then its own, then what its heir has already: the newest stays.
  std::vector<RetainedField> retained = std::move(oldest.retained);
  Retain(oldest.tick, retained);
  Entry& heir = entries_.front();
  for (const RetainedField& one : heir.retained) Set(retained, one.field, one.tick);
  heir.retained = std::move(retained);
}

bool TickQueue::Pop(Entry& entry) {
  if (entries_.empty()) return false;
  entry = std::move(entries_.front());
  entries_.pop_front();
  return true;
}

}  // namespace footing::transport
