#include "common/transport/tick_ring.h"

#include <utility>

#include "common/result/result.h"

namespace footing::transport {
namespace {

std::size_t Cost(const Tick& tick) {
  return sizeof(Tick) + tick.bytes.capacity() + tick.slices.capacity() * sizeof(Slice);
}

}  // namespace

void TickRing::Push(SharedTick tick) {
  FOOTING_CHECK(empty() || tick->sequence == last() + 1);
  bytes_ += Cost(*tick);
  ticks_.push_back(std::move(tick));
}

void TickRing::Trim() {
  while (ticks_.size() > 1 && (ticks_.size() > max_ticks_ || bytes_ > max_bytes_)) {
    bytes_ -= Cost(*ticks_.front());
    ticks_.pop_front();
  }
}

const SharedTick* TickRing::Find(std::uint64_t sequence) const {
  if (empty() || sequence < first() || sequence > last()) return nullptr;
  return &ticks_[sequence - first()];
}

}  // namespace footing::transport
