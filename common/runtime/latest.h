#pragma once

#include <array>
#include <atomic>
#include <cstdint>

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

}  // namespace footing::exchange
