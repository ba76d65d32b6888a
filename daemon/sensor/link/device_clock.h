#pragma once

#include <cstdint>

namespace footing::link {

struct DeviceClockConfig {
  double nominal_period_s = 0.01;
  /// Share of the timing error that one report corrects, when it comes early and when late. A
  /// report cannot come before its sample, so early ones say more.
  double early_gain = 0.3;
  double late_gain = 0.05;
  double period_gain = 0.01;  ///< Share of each correction that the period takes on.
  double max_lag_s = 0.025;   ///< No sample is stamped further back than this.
  double restart_s = 0.25;    ///< A longer pause starts anew.
};

/// Estimates when a sample was taken from when its report arrived.
///
/// Bluetooth delivers in bursts: reports of a device with a steady clock come 2 ms and then 18 ms
/// apart. A phase-locked loop on the report count follows the device's own rate. Real links are not
/// always steady (a Balance Board's reports are not), so the estimate stays within [received -
/// max_lag, received] and never runs backwards.
class DeviceClock {
 public:
  explicit DeviceClock(const DeviceClockConfig& config = {});

  /// One report; returns its sampled_ns. `received_ns` must not go down.
  std::int64_t Advance(std::int64_t received_ns);
  double period_s() const { return period_s_; }

 private:
  DeviceClockConfig config_;
  bool started_ = false;
  double period_s_;
  std::int64_t received_ns_ = 0;
  std::int64_t sampled_ns_ = 0;
};

}  // namespace footing::link
