#pragma once

#include <atomic>

namespace footing::exchange {

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
