#pragma once

#include <cstdint>

namespace footing::transport {

/// Picks the ticks that a session with max_hz gets: on the average at most that many a second, as
/// evenly as the ticks allow. A plain value.
class Decimator {
 public:
  /// `max_hz` 0 takes every tick. `tick_ns` is the nominal interval between ticks.
  Decimator(double max_hz, std::int64_t tick_ns);

  /// Whether the tick of this instant goes out. An instant before the last one resets it.
  bool Take(std::int64_t host_ns);

 private:
  std::int64_t interval_ns_;
  std::int64_t slack_ns_;  ///< Half a tick: a tick that comes a little early is as good.
  std::int64_t due_ns_ = INT64_MIN;
  std::int64_t last_ns_ = INT64_MIN;
};

}  // namespace footing::transport
