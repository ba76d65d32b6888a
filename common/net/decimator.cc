#include "common/net/decimator.h"

#include <algorithm>

#include "common/base/time.h"

namespace footing::transport {

Decimator::Decimator(double max_hz, std::int64_t tick_ns)
    : interval_ns_(max_hz > 0 ? PeriodNanoseconds(max_hz) : 0),
      slack_ns_(std::min(tick_ns, interval_ns_) / 2) {}

bool Decimator::Take(std::int64_t host_ns) {
  if (interval_ns_ == 0) return true;
  const bool restarted = last_ns_ == INT64_MIN || host_ns < last_ns_;
  last_ns_ = host_ns;
  if (!restarted && host_ns < due_ns_ - slack_ns_) return false;
  const std::int64_t earliest = host_ns + interval_ns_ - slack_ns_;
  due_ns_ = restarted ? host_ns + interval_ns_ : std::max(due_ns_ + interval_ns_, earliest);
  return true;
}

}  // namespace footing::transport
