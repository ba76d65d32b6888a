#include "clients/skeleton/tracking/sender_clock.h"

#include <algorithm>

namespace footing::skeleton {
namespace {

constexpr std::int64_t kMostAgeNs = 1'000'000'000;

}  // namespace

std::int64_t SenderClock::Age(std::optional<std::int64_t> sent_ns, bool unix_time,
                              std::int64_t now_ns, std::int64_t wall_ns) {
  if (!sent_ns) return latency_ns_;
  if (unix_time && wall_ns >= *sent_ns && wall_ns - *sent_ns <= kOldestNs)
    return wall_ns - *sent_ns;
  const std::int64_t behind_ns = now_ns - *sent_ns;
  if (now_ns - window_began_ns_ > kWindowNs) {
    least_before_ns_ = least_ns_;
    least_ns_ = kNone;
    window_began_ns_ = now_ns;
  }
  least_ns_ = std::min(least_ns_, behind_ns);
  const std::int64_t age_ns = latency_ns_ + behind_ns - std::min(least_ns_, least_before_ns_);
  if (age_ns <= kMostAgeNs) return age_ns;
  // The sender has set its clock or begun again.
  least_ns_ = behind_ns;
  least_before_ns_ = kNone;
  return latency_ns_;
}

}  // namespace footing::skeleton
