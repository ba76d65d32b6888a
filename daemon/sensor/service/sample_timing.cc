#include "daemon/sensor/service/sample_timing.h"

#include <algorithm>

namespace footing::sensor {

void SampleTiming::Restart(const decode::Timing& timing) {
  timing_ = timing;
  link::DeviceClockConfig config;
  config.nominal_period_s = timing.report_period_s;
  config.sensor_period_s = timing.sensor_period_s;
  clock_ = link::DeviceClock(config);
  statistics_ = link::LinkStatistics(timing.report_period_s);
}

void SampleTiming::Take(std::int64_t received_ns, bool changed) {
  statistics_.Advance(received_ns);
  sampled_ns_ = std::max(sampled_ns_, clock_.Advance(received_ns, changed));
}

std::int64_t SampleTiming::HalfEarlierNs(std::int64_t before_ns) const {
  const auto half_ns = static_cast<std::int64_t>(timing_.report_period_s * 0.5e9);
  return std::clamp(sampled_ns_ - half_ns, before_ns, sampled_ns_);
}

}  // namespace footing::sensor
