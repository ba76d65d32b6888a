#pragma once

#include <algorithm>
#include <cstdint>

namespace footing::handshake {

/// How many writes, or fresh starts, are still allowed: `capacity` at once, then `rate_hz` of them.
class Budget {
 public:
  Budget(double capacity, double rate_hz)
      : capacity_(capacity), rate_hz_(rate_hz), left_(capacity) {}

  /// Takes one; false, and nothing taken, when none is left.
  bool Take(std::int64_t now_ns) {
    if (started_) {
      left_ = std::min(capacity_, left_ + rate_hz_ * 1e-9 * static_cast<double>(now_ns - last_ns_));
    }
    started_ = true;
    last_ns_ = now_ns;
    if (left_ < 1) return false;
    left_ -= 1;
    return true;
  }

 private:
  double capacity_;
  double rate_hz_;
  double left_;
  bool started_ = false;
  std::int64_t last_ns_ = 0;
};

}  // namespace footing::handshake
