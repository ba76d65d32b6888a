#pragma once

#include <algorithm>
#include <cstdint>

#include "common/net/token_bucket.h"

namespace footing::transport {

/// What the other side of a connection may send; rates of 0 do not limit.
struct InputBudget {
  double messages_per_s = 0;
  double message_burst = 0;  ///< At once, after a pause.
  double bytes_per_s = 0;
  double byte_burst = 0;
};

/// What a connection has taken of its budget. A plain value.
class InputPace {
 public:
  explicit InputPace(const InputBudget& budget)
      : messages_(budget.messages_per_s, budget.message_burst),
        bytes_(budget.bytes_per_s, budget.byte_burst) {}

  bool limits() const { return messages_.limits() || bytes_.limits(); }

  void ChargeMessages(double messages) { messages_.Charge(messages); }
  void ChargeBytes(std::size_t bytes) { bytes_.Charge(static_cast<double>(bytes)); }

  /// 0 while a message may be handled; else how long to wait until some are worth it.
  std::int64_t WaitNs(std::int64_t now_ns) {
    constexpr double kMessages = 8, kBytes = 16 << 10;
    if (messages_.HasOne(now_ns) && bytes_.HasOne(now_ns)) return 0;
    return std::max(messages_.WaitNs(now_ns, kMessages), bytes_.WaitNs(now_ns, kBytes));
  }

 private:
  TokenBucket messages_;
  TokenBucket bytes_;
};

}  // namespace footing::transport
