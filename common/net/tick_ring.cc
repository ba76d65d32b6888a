#include "common/net/tick_ring.h"

#include <algorithm>
#include <utility>

#include "common/base/result.h"

namespace footing::transport {
namespace {

std::size_t Cost(const Tick& tick) {
  return sizeof(Tick) + tick.bytes.capacity() + tick.slices.capacity() * sizeof(Slice);
}

}  // namespace

void TickRing::Push(SharedTick tick) {
  FOOTING_CHECK(empty() || tick->sequence > last());
  bytes_ += Cost(*tick);
  ticks_.push_back(std::move(tick));
  while (ticks_.size() > 1 && (ticks_.size() > max_ticks_ || bytes_ > max_bytes_)) {
    bytes_ -= Cost(*ticks_.front());
    ticks_.pop_front();
  }
}

std::size_t TickRing::IndexFrom(std::uint64_t sequence) const {
  const auto found = std::lower_bound(
      ticks_.begin(), ticks_.end(), sequence,
      [](const SharedTick& tick, std::uint64_t wanted) { return tick->sequence < wanted; });
  return static_cast<std::size_t>(found - ticks_.begin());
}

const SharedTick* TickRing::AtOrAfter(std::uint64_t sequence) const {
  const std::size_t index = IndexFrom(sequence);
  return index < ticks_.size() ? &ticks_[index] : nullptr;
}

std::size_t TickRing::CountFrom(std::uint64_t sequence) const {
  return ticks_.size() - IndexFrom(sequence);
}

}  // namespace footing::transport
