#pragma once

#include <algorithm>
#include <cstdint>

namespace footing::transport {

/// How much somebody may do: `per_s` a second on the average, `burst` at once. What is done is
/// charged afterwards, so that the level may fall below zero; the next one waits that much longer.
/// A plain value; instants are nanoseconds of any one clock. A rate of 0 never limits.
class TokenBucket {
 public:
  TokenBucket() = default;
  TokenBucket(double per_s, double burst) : per_s_(per_s), burst_(burst), level_(burst) {}

  bool limits() const { return per_s_ > 0; }

  void Charge(double tokens) { level_ -= tokens; }

  /// Whether at least one token is there.
  bool HasOne(std::int64_t now_ns) { return !limits() || Level(now_ns) >= 1; }

  /// Takes one token if it is there.
  bool Take(std::int64_t now_ns) {
    if (!HasOne(now_ns)) return false;
    Charge(1);
    return true;
  }

  /// How long until the level is `tokens` (at most the burst); 0 when it is.
  std::int64_t WaitNs(std::int64_t now_ns, double tokens) {
    if (!limits()) return 0;
    const double missing = std::min(tokens, burst_) - Level(now_ns);
    return missing <= 0 ? 0 : static_cast<std::int64_t>(missing / per_s_ * 1e9) + 1;
  }

 private:
  double Level(std::int64_t now_ns) {
    if (filled_ns_ != 0 && now_ns > filled_ns_) {
      level_ = std::min(burst_, level_ + static_cast<double>(now_ns - filled_ns_) * 1e-9 * per_s_);
    }
    filled_ns_ = now_ns;
    return level_;
  }

  double per_s_ = 0;
  double burst_ = 0;
  double level_ = 0;
  std::int64_t filled_ns_ = 0;
};

}  // namespace footing::transport
