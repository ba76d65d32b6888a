#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>

namespace footing::link {

/// Settings of the fit of a sensor's own ticks.
struct SampleTicksConfig {
  double nominal_period_s = 0.01;  ///< Period of the sensor, not of its reports.
  double window_s = 8;             ///< Time that the fit looks back on.
  double refit_s = 1;     ///< Between fits once the ticks are known over a whole window ...
  double search_s = 0.5;  ///< ... and until then.
  /// How far the sensor's period may be from its nominal value (1 = the same).
  double period_range = 0.05;
  /// Without anything to fit to for this time, the ticks are no longer known: a period good to 10
  /// ppm then is 1 ms off.
  double coast_s = 100;
};

/// Finds when a device's sensor takes its samples, from which reports brought something new.
///
/// A sensor measures at even ticks and holds each value until the next; the radio sends what is
/// held, whenever its turn comes. So a report that differs from the one before says that a tick
/// lies between the two arrivals, and one that repeats it, that most likely none does (a device at
/// rest repeats too; that is as likely at any phase, and so changes no choice). Intervals shorter
/// than a period bound the ticks' phase, and many of them leave little choice: each fit takes, of a
/// range of periods and all phases, the pair that the reports of the window speak for most. Devices
/// that do not hold their samples speak for none, and get none.
///
/// Times are arrivals at the radio's end; a constant delay before them can't be seen.
class SampleTicks {
 public:
  explicit SampleTicks(const SampleTicksConfig& config = {});

  /// One report. `received_ns` must not go down. `changed`: it differs from the one before.
  void Add(std::int64_t received_ns, bool changed);

  bool known() const { return known_; }
  /// The last tick at or before `at_ns`. Asked only when known.
  std::int64_t TickBefore(std::int64_t at_ns) const;
  double period_s() const { return period_s_; }
  /// Standard deviation of the ticks' phase, s: the phases that explain the reports equally well
  /// are taken as equally likely. Asked only when known.
  double phase_sd_s() const;

 private:
  static constexpr int kBins = 256;

  /// A pair of arrivals nearer to each other than a period.
  struct Pair {
    std::int64_t from_ns = 0;
    std::int64_t to_ns = 0;
    bool changed = false;
  };
  struct Fit {
    double period_s = 0;
    double phase = 0;         ///< Phase of the ticks after the newest arrival, in periods.
    double score = 0;         ///< Pairs that speak for it, less those against.
    double significance = 0;  ///< Standard deviations above the score of any phase.
    int changes = 0;
    double phase_range = 0;  ///< Width of the phases that score as high as the best, in periods.
  };

  void Refit();
  /// The best phase at this period.
  Fit At(double period_s, double window_s) const;
  Fit Search(std::size_t first_stage, double period_s) const;
  bool IsGood(const Fit& fit) const;

  SampleTicksConfig config_;
  std::deque<Pair> pairs_;  // Oldest first.
  bool started_ = false;
  std::int64_t begun_ns_ = 0;
  std::int64_t last_ns_ = 0;
  std::int64_t fitted_ns_ = 0;
  bool known_ = false;
  double period_s_;
  double phase_range_ = 0;      // Width in the last good fit, in periods.
  std::int64_t tick_ns_ = 0;    // One of the ticks.
  std::int64_t proved_ns_ = 0;  // When the last good fit was.
};

/// Settings of the loop that estimates sample times.
struct DeviceClockConfig {
  double nominal_period_s = 0.01;  ///< Period of reports.
  double sensor_period_s = 0;      ///< Period of new samples; 0: as the reports.
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
  /// before. Reports are taken to be a period apart; lost ones show in arrivals only.
  std::int64_t Advance(std::int64_t received_ns, bool changed = true);
  /// Period of the sensor's samples, once its ticks are known; until then of the reports.
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
  double loop_variance_s2_ = 0;  ///< Variance of the loop's timing error, over about a second.
};

/// Turns times of a device's own clock into the host's, from when its reports arrive. Links delay
/// them (Bluetooth by some 10 ms, Wi-Fi by 50 to 300) and never hasten them. So of all lines that
/// lie below the arrivals over the device's times of the newest 10 s, the nearest one is the host's
/// time, up to the shortest delay (Moon, Skelly & Towsley 1999). A plain value.
class OwnClock {
 public:
  /// A difference of the clocks that jumps by more is another start of the device's clock.
  static constexpr std::int64_t kJumpNs = 2'000'000'000;

  /// `rate_range`: share by which the device's clock may be faster or slower than the host's.
  explicit OwnClock(double rate_range = 2e-4) : rate_range_(rate_range) {}

  /// One report, whose newest sample is of `own_ns`.
  void Take(std::int64_t received_ns, std::int64_t own_ns);
  /// Asked after Take.
  std::int64_t HostNs(std::int64_t own_ns) const;
  /// As DeviceClock::sampled_sd_s: how far the fastest report of each second is from the line.
  double sampled_sd_s() const;

 private:
  /// The report of a second that came fastest.
  struct Fastest {
    std::int64_t from_ns = 0;
    std::int64_t received_ns = 0;
    std::int64_t own_ns = 0;
  };
  void Fit();
  double Behind(const Fastest& one, double rate) const;

  double rate_range_;
  std::deque<Fastest> seconds_;
  double rate_ = 1;                        ///< Host's seconds in one of the device's.
  std::int64_t own_ns_ = 0, host_ns_ = 0;  ///< A point of the line.
};

/// How a device's data reports arrive: rate, jitter, gaps. Rate and jitter are exponential means
/// over about one second.
class LinkStatistics {
 public:
  /// `nominal_period_s`: a longer interval than five of these is a gap.
  explicit LinkStatistics(double nominal_period_s) : nominal_period_s_(nominal_period_s) {}

  void Advance(std::int64_t received_ns);

  /// 0 when nothing came for `now_ns` - one second.
  double RateHz(std::int64_t now_ns) const;
  /// Standard deviation of the interval between reports, ms.
  double JitterMs() const;
  std::uint64_t reports() const { return reports_; }
  std::uint64_t gaps() const { return gaps_; }
  std::int64_t last_ns() const { return last_ns_; }

 private:
  double nominal_period_s_;
  std::uint64_t reports_ = 0;
  std::uint64_t gaps_ = 0;
  std::int64_t last_ns_ = 0;
  double mean_s_ = 0;
  double variance_s2_ = 0;
};

}  // namespace footing::link
