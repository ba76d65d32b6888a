#include "common/transport/tick_queue.h"

#include <algorithm>

namespace footing::transport {
namespace {

void Set(std::vector<CarriedField>& carried, std::uint32_t field, const SharedTick& tick) {
  for (CarriedField& one : carried) {
    if (one.field == field) {
      one.tick = tick;
      return;
    }
  }
  carried.push_back({field, tick});
}

}  // namespace

TickQueue::TickQueue(QueueRule rule, std::size_t capacity, std::set<std::uint32_t> retained)
    : rule_(rule),
      capacity_(rule == QueueRule::kLatest ? 1 : std::max<std::size_t>(1, capacity)),
      retained_(std::move(retained)) {}

void TickQueue::Carry(const SharedTick& tick, std::vector<CarriedField>& carried) const {
  for (const Slice& slice : tick->slices) {
    if (retained_.count(slice.field) > 0) Set(carried, slice.field, tick);
  }
}

void TickQueue::Skip(const SharedTick& tick) { Carry(tick, for_next_); }

bool TickQueue::Push(SharedTick tick) {
  if (entries_.size() >= capacity_) {
    if (rule_ == QueueRule::kReliable) return false;
    Entry entry{std::move(tick), std::exchange(for_next_, {})};
    entries_.push_back(std::move(entry));
    DropOldest();
    return true;
  }
  entries_.push_back({std::move(tick), std::exchange(for_next_, {})});
  return true;
}

void TickQueue::DropOldest() {
  Entry oldest = std::move(entries_.front());
  entries_.pop_front();
  const std::uint64_t sequence = oldest.tick->sequence;
  dropped_ = Dropped{dropped_ ? dropped_->from : sequence, sequence};
  ++dropped_ticks_;
  // What the dropped one contained, then its own, then what its heir has already: the newest stays.
  std::vector<CarriedField> carried = std::move(oldest.carried);
  Carry(oldest.tick, carried);
  Entry& heir = entries_.front();
  for (const CarriedField& one : heir.carried) Set(carried, one.field, one.tick);
  heir.carried = std::move(carried);
}

bool TickQueue::Pop(Entry& entry) {
  if (entries_.empty()) return false;
  entry = std::move(entries_.front());
  entries_.pop_front();
  return true;
}

}  // namespace footing::transport
