#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace footing::exchange {

/// The newest value of one writer for one reader, without locks or allocation after construction.
///
/// Three slots: one being written, one being read, one in between that the two swap. The reader
/// always gets the newest complete value; values it did not ask for in time are overwritten.
template <typename T>
class Latest {
 public:
  explicit Latest(const T& initial = T()) : slots_{initial, initial, initial} {}
  Latest(const Latest&) = delete;
  Latest& operator=(const Latest&) = delete;

  /// Writer's side: a slot to fill in place, then Publish().
  T& Back() { return slots_[back_]; }
  void Publish() { back_ = between_.exchange(back_ | kFresh, std::memory_order_acq_rel) & kIndex; }
  void Write(const T& value) {
    Back() = value;
    Publish();
  }

  /// Reader's side: takes the newest value if there is one since the last call; says whether.
  bool Refresh() {
    if ((between_.load(std::memory_order_acquire) & kFresh) == 0) return false;
    front_ = between_.exchange(front_, std::memory_order_acq_rel) & kIndex;
    return true;
  }
  /// The value of the last Refresh().
  const T& Front() const { return slots_[front_]; }

 private:
  static constexpr std::uint32_t kIndex = 3;
  static constexpr std::uint32_t kFresh = 4;

  std::array<T, 3> slots_;
  std::uint32_t back_ = 0;
  std::uint32_t front_ = 1;
  std::atomic<std::uint32_t> between_{2};
};

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

/// When a thread last came round its loop, for another thread that watches it.
class Heartbeat {
 public:
  void Beat(std::int64_t now_ns) { last_ns_.store(now_ns, std::memory_order_relaxed); }
  /// Whether it has begun and not come round for longer than that.
  bool StuckFor(std::int64_t longest_ns, std::int64_t now_ns) const {
    const std::int64_t last_ns = last_ns_.load(std::memory_order_relaxed);
    return last_ns != 0 && now_ns - last_ns > longest_ns;
  }

 private:
  std::atomic<std::int64_t> last_ns_{0};
};

/// A flag that one thread raises and others see, for "stop now" and "something is there".
class Flag {
 public:
  void Raise() { raised_.store(true, std::memory_order_release); }
  void Lower() { raised_.store(false, std::memory_order_release); }
  bool raised() const { return raised_.load(std::memory_order_acquire); }
  /// Raises it and says whether it was lowered before.
  bool RaiseIfLowered() { return !raised_.exchange(true, std::memory_order_acq_rel); }

 private:
  std::atomic<bool> raised_{false};
};

}  // namespace footing::exchange
