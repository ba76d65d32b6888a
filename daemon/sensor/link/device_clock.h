#pragma once

#include <cstdint>

namespace footing::link {

struct DeviceClockConfig {
  double nominal_period_s = 0.01;  ///< Between two reports.
  double sensor_period_s = 0.01;   ///< Between two samples of the sensor.
  /// A link that delivers every sample once: share of the timing error that one report corrects,
  /// when it comes early and when late. A report cannot come before its sample, so early ones say
  /// more.
  double early_gain = 0.3;
  double late_gain = 0.05;
  double period_gain = 0.01;  ///< Share of each correction that the period takes on.
  double max_lag_s = 0.025;   ///< No sample is stamped further back than this.
  double restart_s = 0.25;    ///< A longer pause starts anew.
  /// A link that samples a held value: share of a contradiction that phase and period take on.
  double phase_gain = 0.5;
  double held_period_gain = 0.005;
  double held_period_range = 0.05;  ///< The period stays within this share of sensor_period_s.
};

/// Estimates when a sample was taken from when its report arrived, and from whether it is new.
///
/// A Wiimote or a board holds its newest sample, and whenever the link is free a report takes it
/// along: some are sent twice, some never, and when a report arrives says nothing of the sensor's
/// clock. What does is change: with a new value a tick of the sensor lies between this report and
/// the one before, with the same value (of a moving sensor) none does. The clock keeps a grid of
/// ticks and moves it only when it contradicts such an observation; a sample's time is then the
/// last tick before its report. A sensor at rest repeats itself without meaning it, so repeats
/// count only while most reports are new.
///
/// Where even reports that follow each other closely are new, each carries a sample of its own
/// through a queue, and a phase-locked loop on the report count follows the device's rate instead:
/// Bluetooth delivers in bursts, 2 ms and then 18 ms apart.
///
/// Either way the estimate stays within [received - max_lag, received] and never runs backwards.
class DeviceClock {
 public:
  explicit DeviceClock(const DeviceClockConfig& config = {});

  /// One report; returns its sampled_ns. `received_ns` must not go down. `changed`: its value
  /// differs from that of the report before.
  std::int64_t Advance(std::int64_t received_ns, bool changed = true);
  /// Of the sensor's samples.
  double period_s() const { return held_ ? tick_period_s_ : period_s_; }
  /// Whether reports sample a held value.
  bool held() const { return held_; }

 private:
  std::int64_t AdvanceLoop(std::int64_t received_ns);
  std::int64_t AdvanceGrid(std::int64_t before_ns, std::int64_t received_ns, bool changed);

  DeviceClockConfig config_;
  bool started_ = false;
  std::int64_t received_ns_ = 0;
  std::int64_t sampled_ns_ = 0;

  double period_s_;
  std::int64_t loop_ns_ = 0;

  bool held_ = false;
  double changed_share_ = 1;
  double short_share_ = 1;
  int reports_ = 0;
  double tick_period_s_;
  std::int64_t tick_ns_ = 0;  ///< A tick of the sensor, the last one up to the newest report.
};

}  // namespace footing::link
