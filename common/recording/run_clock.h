#pragma once

#include <cstdint>

#include "common/recording/recorded_session.h"
#include "common/base/result.h"

namespace footing::bids {

/// An instant of a server's clock on the wall clock of the recorder's host, on which all servers
/// agree; 0 where the recording's times are not those of a host.
std::int64_t WallNs(const recording::RecordedServer& server, std::int64_t host_ns);

/// Seconds since the start of a data set's run, of an instant on a server's clock.
class RunClock {
 public:
  /// InvalidData where the recording's times are not those of a host.
  static Result<RunClock> Of(const recording::RecordedServer& server, std::int64_t zero_wall_ns);
  /// NaN for an instant that no clock can show.
  double operator()(std::int64_t host_ns) const;

 private:
  std::int64_t offset_ns_ = 0;
};

}  // namespace footing::bids
