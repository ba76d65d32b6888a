#pragma once

#include <boost/circular_buffer.hpp>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "common/net/tick.h"

namespace footing::transport {

/// What a session's full queue does; numbers as in v1::QueuePolicy.
enum class QueueRule { kLatest = 1, kDropOldest = 2, kReliable = 3 };

/// A channel's field out of another tick than the one it goes along with.
struct RetainedField {
  std::uint32_t field = 0;
  SharedTick tick;
};

/// Ticks dropped because the queue was full: first and last sequence.
struct Dropped {
  std::uint64_t from = 0;
  std::uint64_t to = 0;
};

/// The ticks that wait for one session, bounded, with the ticks themselves shared.
///
/// A retained channel says how things stand, so its newest value must not be lost with a tick that
/// was dropped or left out by decimation: it is added to the next tick that goes out.
class TickQueue {
 public:
  struct Entry {
    SharedTick tick;
    std::vector<RetainedField> retained;
  };

  TickQueue() = default;
  /// `capacity` >= 1; kLatest has one of 1 whatever is said. `retained`: fields that are retained.
  TickQueue(QueueRule rule, std::size_t capacity, std::set<std::uint32_t> retained);

  /// False for kReliable when the queue is full: the session has to end.
  bool Push(SharedTick tick);
  /// A tick that is left out on purpose: nothing is missing, but retained channels are kept.
  void Skip(const SharedTick& tick);

  /// What was dropped in front of the oldest tick, once.
  std::optional<Dropped> TakeDropped() { return std::exchange(dropped_, std::nullopt); }
  bool Pop(Entry& entry);

  /// The oldest tick that waits; null: none.
  const Tick* oldest() const { return entries_.empty() ? nullptr : entries_.front().tick.get(); }

  bool empty() const { return entries_.empty(); }
  std::size_t size() const { return entries_.size(); }
  std::uint64_t dropped_ticks() const { return dropped_ticks_; }

 private:
  void Add(SharedTick tick);
  void DropOldest();
  void Retain(const SharedTick& tick, std::vector<RetainedField>& retained) const;

  QueueRule rule_ = QueueRule::kDropOldest;
  std::size_t capacity_ = 1;
  std::set<std::uint32_t> retained_;
  /// Grows when it must. Mostly one tick waits at a time, and a server of a thousand sessions
  /// should find it in few lines of the cache.
  boost::circular_buffer<Entry> entries_;
  std::vector<RetainedField> for_next_;  ///< Retained fields of ticks skipped since the last Push.
  std::optional<Dropped> dropped_;
  std::uint64_t dropped_ticks_ = 0;
};

}  // namespace footing::transport
