#pragma once

#include <cstdint>

#include "daemon/sensor/kinds/kind_options.h"
#include "daemon/sensor/reports/device_clock.h"
#include "daemon/sensor/reports/link_statistics.h"

namespace footing::sensor {

/// When a device's samples were taken, and how its link fares.
class SampleTiming {
 public:
  /// A new uninterrupted stream begins.
  void Restart(const decode::Timing& timing);

  /// A report with a new measurement or a repeated one (`changed` false).
  void Take(std::int64_t received_ns, bool changed);
  /// Of the newest sample; never goes back.
  std::int64_t sampled_ns() const { return sampled_ns_; }
  /// Of the older of two samples in the newest report, half a report earlier; `before_ns` is the
  /// newest sample of the report before.
  std::int64_t HalfEarlierNs(std::int64_t before_ns) const;

  /// How well sample times are known (link::DeviceClock::sampled_sd_s), s; negative: not yet.
  double sampled_sd_s() const { return clock_.sampled_sd_s(); }
  const link::LinkStatistics& statistics() const { return statistics_; }

 private:
  decode::Timing timing_;
  link::DeviceClock clock_;
  link::LinkStatistics statistics_{0.01};
  std::int64_t sampled_ns_ = 0;
};

}  // namespace footing::sensor
