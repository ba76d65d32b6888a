#include "daemon/sensor/reports/device_clock.h"

#include <algorithm>
#include <cmath>

#include "common/base/time.h"
#include "common/base/units.h"

namespace footing::link {
namespace {

/// The period may differ this much from its nominal value, by a factor either way.
constexpr double kPeriodRange = 2;
/// A tick that was this share of a period off (1/8) is taken to have come.
constexpr std::int64_t kEarlyShare = 8;
/// Steps of the loop after which the variance of its errors is an estimate.
constexpr int kSteadySteps = 100;
constexpr double kVarianceGain = 0.01;

SampleTicksConfig TicksOf(const DeviceClockConfig& config) {
  SampleTicksConfig ticks;
  ticks.nominal_period_s =
      config.sensor_period_s > 0 ? config.sensor_period_s : config.nominal_period_s;
  return ticks;
}

}  // namespace

DeviceClock::DeviceClock(const DeviceClockConfig& config)
    : config_(config), ticks_(TicksOf(config)), period_s_(config.nominal_period_s) {}

std::int64_t DeviceClock::Advance(std::int64_t received_ns, bool changed) {
  // A clock that went back, which none should, restarts everything.
  if (started_ && received_ns < received_ns_) *this = Restarted();
  AdvanceLoop(received_ns);
  ticks_.Add(received_ns, changed);
  std::int64_t estimate_ns = loop_ns_;
  if (ticks_.known()) {
    estimate_ns = ticks_.TickBefore(received_ns);
    const auto period_ns = RoundToNanoseconds(ticks_.period_s());
    // Something new with no tick since the last: the tick was just about to come.
    if (changed && estimate_ns <= sampled_ns_ &&
        estimate_ns + period_ns - received_ns < period_ns / kEarlyShare) {
      estimate_ns = received_ns;
    }
  }
  sampled_ns_ = std::max(sampled_ns_, estimate_ns);
  return sampled_ns_;
}

double DeviceClock::sampled_sd_s() const {
  if (loop_steps_ < kSteadySteps) return -1;
  // A report nearer to a tick than the phase is known may be given the sample of the tick beside
  // it, which is a period off: variance = period^2 * (phase sd / period).
  if (ticks_.known()) return std::sqrt(ticks_.period_s() * ticks_.phase_sd_s());
  // A sensor that holds its samples sends one of any age up to its period; the loop's own phase has
  // the variance of a first-order loop of that gain.
  const double period_s =
      config_.sensor_period_s > 0 ? config_.sensor_period_s : config_.nominal_period_s;
  const double gain = (config_.early_gain + config_.late_gain) / 2;
  return std::sqrt(period_s * period_s / 12 + loop_variance_s2_ * gain / (2 - gain));
}

DeviceClock DeviceClock::Restarted() const {
  DeviceClock clock(config_);
  clock.sampled_ns_ = sampled_ns_;
  return clock;
}

void DeviceClock::AdvanceLoop(std::int64_t received_ns) {
  const std::int64_t pause_ns = received_ns - received_ns_;
  received_ns_ = received_ns;
  if (!started_ || pause_ns > RoundToNanoseconds(config_.restart_s)) {
    started_ = true;
    loop_steps_ = 0;
    loop_variance_s2_ = 0;
    loop_ns_ = received_ns;
    return;
  }
  const std::int64_t predicted_ns = loop_ns_ + RoundToNanoseconds(period_s_);
  const double error_s = NanosecondsToSeconds(received_ns - predicted_ns);
  loop_steps_ = std::min(loop_steps_ + 1, kSteadySteps);
  loop_variance_s2_ +=
      std::max(kVarianceGain, 1.0 / loop_steps_) * (error_s * error_s - loop_variance_s2_);
  const double gain = error_s < 0 ? config_.early_gain : config_.late_gain;
  std::int64_t estimate_ns = predicted_ns + RoundToNanoseconds(gain * error_s);
  estimate_ns =
      std::clamp(estimate_ns, received_ns - RoundToNanoseconds(config_.max_lag_s), received_ns);
  loop_ns_ = std::max(estimate_ns, loop_ns_);
  // What the estimate is moved by, all bounds included, is zero on average once the period is
  // right.
  const double moved_s = NanosecondsToSeconds(loop_ns_ - predicted_ns);
  period_s_ =
      std::clamp(period_s_ + config_.period_gain * moved_s, config_.nominal_period_s / kPeriodRange,
                 config_.nominal_period_s * kPeriodRange);
}

}  // namespace footing::link
