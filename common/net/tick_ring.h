#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>

#include "common/net/tick.h"

namespace footing::transport {

/// The last ticks, by rising sequence, bounded in number and in bytes. The newest is always held.
/// The sequences of a relay's ticks have holes where it left ticks out.
class TickRing {
 public:
  TickRing(std::size_t max_ticks, std::size_t max_bytes)
      : max_ticks_(max_ticks), max_bytes_(max_bytes) {}

  /// The tick's sequence is above the last one's. Lets go what is over the bounds.
  void Push(SharedTick tick);

  /// The first one held from this sequence on; null when there is none yet.
  const SharedTick* AtOrAfter(std::uint64_t sequence) const;
  /// How many are held from this sequence on.
  std::size_t CountFrom(std::uint64_t sequence) const;

  bool empty() const { return ticks_.empty(); }
  /// Of the oldest and the newest tick held; 0 when there is none.
  std::uint64_t first() const { return empty() ? 0 : ticks_.front()->sequence; }
  std::uint64_t last() const { return empty() ? 0 : ticks_.back()->sequence; }
  std::size_t bytes() const { return bytes_; }

 private:
  std::size_t IndexFrom(std::uint64_t sequence) const;

  std::size_t max_ticks_;
  std::size_t max_bytes_;
  std::size_t bytes_ = 0;
  std::deque<SharedTick> ticks_;
};

}  // namespace footing::transport
