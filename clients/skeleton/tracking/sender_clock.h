#pragma once

#include <cstdint>
#include <limits>
#include <optional>

namespace footing::skeleton {

/// How old an exposure is by the sender's own time. A sender on this host, or with a synchronised
/// clock, gives it at once. Of any other clock only differences mean something: the fastest packet
/// of the last 10 to 20 s is taken to have needed `latency`, the others longer. A plain value.
class SenderClock {
 public:
  static constexpr std::int64_t kOldestNs = 500'000'000;  ///< Older ones have another clock.
  static constexpr std::int64_t kWindowNs = 10'000'000'000;

  explicit SenderClock(std::int64_t latency_ns) : latency_ns_(latency_ns) {}

  /// `sent_ns`: none where the sender gives no time; `unix_time`: it counts from 1970, as
  /// `wall_ns` does. `now_ns` is monotonic and does not decrease. The age is 0 to 1 s.
  std::int64_t Age(std::optional<std::int64_t> sent_ns, bool unix_time, std::int64_t now_ns,
                   std::int64_t wall_ns);

 private:
  static constexpr std::int64_t kNone = std::numeric_limits<std::int64_t>::max();

  std::int64_t latency_ns_;
  std::int64_t window_began_ns_ = 0;
  std::int64_t least_ns_ = kNone, least_before_ns_ = kNone;  // Of this window, of the last one.
};

}  // namespace footing::skeleton
