#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace footing::exchange {

/// A queue of fixed size between one producer thread and one consumer thread.
///
/// No locks, no allocation after construction. When it is full the newest item is refused and
/// counted, as hidraw's own queue does: the consumer sees the count and can detect a gap.
template <typename T>
class BoundedQueue {
 public:
  explicit BoundedQueue(std::size_t capacity) : slots_(capacity + 1) {}
  BoundedQueue(const BoundedQueue&) = delete;
  BoundedQueue& operator=(const BoundedQueue&) = delete;

  /// Producer's side. False, and counted, when the queue is full.
  bool Push(T item) {
    const std::size_t tail = tail_.load(std::memory_order_relaxed);
    const std::size_t next = Next(tail);
    if (next == head_.load(std::memory_order_acquire)) {
      refused_.fetch_add(1, std::memory_order_relaxed);
      return false;
    }
    slots_[tail] = std::move(item);
    tail_.store(next, std::memory_order_release);
    return true;
  }

  /// Consumer's side. False when the queue is empty.
  bool Pop(T& item) {
    const std::size_t head = head_.load(std::memory_order_relaxed);
    if (head == tail_.load(std::memory_order_acquire)) return false;
    item = std::move(slots_[head]);
    head_.store(Next(head), std::memory_order_release);
    return true;
  }

  /// How many items were refused so far.
  std::uint64_t refused() const { return refused_.load(std::memory_order_relaxed); }

 private:
  std::size_t Next(std::size_t index) const { return index + 1 == slots_.size() ? 0 : index + 1; }

  std::vector<T> slots_;
  std::atomic<std::size_t> head_{0};
  std::atomic<std::size_t> tail_{0};
  std::atomic<std::uint64_t> refused_{0};
};

}  // namespace footing::exchange
