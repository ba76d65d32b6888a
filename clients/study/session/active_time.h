#pragma once

#include <cstdint>

namespace footing::study {

/// How long a participant has been moving: the time during which footingd reports that a controller
/// on the body moves. Thumbs on a joystick and weight on boards do not count.
class ActiveTime {
 public:
  /// From each tick; `host_ns` is the server's clock. Time across a gap in the stream, or before
  /// the first tick, is not counted.
  void Add(std::int64_t host_ns, bool moving);
  double seconds() const { return seconds_; }

 private:
  std::int64_t last_ns_ = 0;
  double seconds_ = 0;
};

}  // namespace footing::study
