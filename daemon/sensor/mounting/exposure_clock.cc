#include "daemon/sensor/mounting/exposure_clock.h"

#include <algorithm>
#include <cmath>

#include "common/stream/hands.h"

namespace footing::hands {
namespace {

constexpr double kPeriodGain = 0.1;
/// A longer interval is a pause of the source, and no period.
constexpr std::int64_t kLongestPeriodNs = 500'000'000;

/// A time that cannot be right is of another host's clock.
bool IsSentKnown(const FrameTimes& times) {
  return times.sent_ns > 0 && times.sent_ns <= times.received_ns &&
         times.received_ns - times.sent_ns <= stream::kOldestPointNs;
}

}  // namespace

ExposureClock::Exposure ExposureClock::Take(const FrameTimes& times) {
  const bool exact = IsSentKnown(times);
  const bool together = started_ && times.received_ns == received_ns_;
  Exposure exposure;
  exposure.sampled_ns = (exact ? times.sent_ns : times.received_ns) - times.age_ns;
  if (started_ && !together) {
    const std::int64_t interval_ns = exposure.sampled_ns - sampled_ns_;
    if (interval_ns > 0 && interval_ns < kLongestPeriodNs) {
      const auto one_ns = static_cast<double>(interval_ns);
      period_ns_ += (period_ns_ > 0 ? kPeriodGain : 1) * (one_ns - period_ns_);
    }
    published_ns_ = sampled_ns_;
    waiting_ = 0;
  }
  if (together && !exact && waiting_ > 0) {
    // They stay later than what was published before, in their order.
    exposure.others_earlier_ns =
        std::clamp<std::int64_t>(std::llround(period_ns_), 0, (oldest_ns_ - published_ns_) / 2);
    oldest_ns_ -= exposure.others_earlier_ns;
    sampled_ns_ -= exposure.others_earlier_ns;
  }
  if (started_) exposure.sampled_ns = std::max(exposure.sampled_ns, sampled_ns_ + 1);
  if (!started_) published_ns_ = exposure.sampled_ns - kLongestPeriodNs;
  if (waiting_++ == 0) oldest_ns_ = exposure.sampled_ns;
  started_ = true;
  received_ns_ = times.received_ns;
  sampled_ns_ = exposure.sampled_ns;
  return exposure;
}

void ExposureClock::Publish() {
  published_ns_ = sampled_ns_;
  waiting_ = 0;
}

}  // namespace footing::hands
