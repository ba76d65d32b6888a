#include "clients/study/session/active_time.h"

#include "common/base/units.h"

namespace footing::study {
namespace {

constexpr double kLongestTickS = 0.5;  // A longer interval is a gap: ticks come 100 times a second.

}  // namespace

void ActiveTime::Add(std::int64_t host_ns, bool moving) {
  const double passed_s = NanosecondsToSeconds(host_ns - last_ns_);
  if (moving && passed_s > 0 && passed_s <= kLongestTickS) seconds_ += passed_s;
  last_ns_ = host_ns;
}

}  // namespace footing::study
