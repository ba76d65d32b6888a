#pragma once

#include <atomic>
#include <cstdint>

namespace footing::exchange {

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

}  // namespace footing::exchange
