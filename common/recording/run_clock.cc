#include "common/recording/run_clock.h"

#include <limits>

#include "common/base/instant.h"
#include "common/base/units.h"

namespace footing::bids {
namespace {

bool IsOfAHost(const recording::RecordedServer& server) {
  return IsInstant(server.wall_time_ns) && IsInstant(server.host_ns);
}

}  // namespace

std::int64_t WallNs(const recording::RecordedServer& server, std::int64_t host_ns) {
  return IsOfAHost(server) ? host_ns + server.wall_time_ns - server.host_ns : 0;
}

Result<RunClock> RunClock::Of(const recording::RecordedServer& server, std::int64_t zero_wall_ns) {
  const bool known = IsOfAHost(server) && IsInstant(zero_wall_ns);
  RunClock clock;
  if (known) clock.offset_ns_ = server.wall_time_ns - server.host_ns - zero_wall_ns;
  if (!known || !IsInstant(clock.offset_ns_)) {
    return InvalidData("the times of " + server.name + " are not those of a host");
  }
  return clock;
}

double RunClock::operator()(std::int64_t host_ns) const {
  return IsInstant(host_ns) ? NanosecondsToSeconds(host_ns + offset_ns_)
                            : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace footing::bids
