#pragma once

#include <cstdint>

#include "daemon/sensor/reports/sample_ticks.h"

namespace footing::link {

struct DeviceClockConfig {
  double nominal_period_s = 0.01;  ///< Of reports.
  double sensor_period_s = 0;      ///< Of new samples; 0: as the reports.
  /// Share of the timing error that one report corrects, when it comes early and when late. A
  /// report cannot come before its sample, so early ones say more.
  double early_gain = 0.3;
  double late_gain = 0.05;
  double period_gain = 0.01;  ///< Share of each correction that the period takes on.
  double max_lag_s = 0.025;   ///< No sample is stamped further back than this.
  double restart_s = 0.25;    ///< A longer pause restarts the estimate.
};

/// Estimates when a sample was taken from when its report arrived.
///
/// Bluetooth delivers in bursts: reports of a device with a steady clock come 2 ms and then 18 ms
/// apart. Where the ticks of the sensor are known (SampleTicks), a sample is as old as the last
/// tick. Until then, and for devices that show none, a phase-locked loop on the report count
/// follows the device's own rate and stays within [received - max_lag, received]. Either way the
/// estimate needs no later report, is never after the arrival and never runs backwards.
class DeviceClock {
 public:
  explicit DeviceClock(const DeviceClockConfig& config = {});

  /// One report; returns its sampled_ns. `changed`: the sensor took a new sample since the report
  /// before.
  std::int64_t Advance(std::int64_t received_ns, bool changed = true);
  /// Of the sensor's samples, once its ticks are known; until then of the reports.
  double period_s() const { return ticks_.known() ? ticks_.period_s() : period_s_; }
  /// Whether the ticks of the sensor are known.
  bool held() const { return ticks_.known(); }
  /// Standard deviation of the estimated sample times about the true ones, a constant delay apart,
  /// s; negative until there are enough reports to say so.
  double sampled_sd_s() const;

 private:
  void AdvanceLoop(std::int64_t received_ns);
  DeviceClock Restarted() const;

  DeviceClockConfig config_;
  SampleTicks ticks_;
  bool started_ = false;
  double period_s_;
  std::int64_t received_ns_ = 0;
  std::int64_t loop_ns_ = 0;  ///< The loop's own estimate.
  std::int64_t sampled_ns_ = 0;
  int loop_steps_ = 0;           ///< Since the loop started, at most kSteadySteps.
  double loop_variance_s2_ = 0;  ///< Of the loop's timing error, over about a second.
};

}  // namespace footing::link
