#include "daemon/sensor/link/device_clock.h"

#include <algorithm>
#include <cmath>

namespace footing::link {
namespace {

std::int64_t Nanoseconds(double seconds) { return std::llround(seconds * 1e9); }
double Seconds(std::int64_t ns) { return static_cast<double>(ns) * 1e-9; }

/// The period of the loop may differ this much from its nominal value, by a factor either way.
constexpr double kPeriodRange = 2;
/// Share of new values among reports that follow the one before by less than kShort periods of the
/// sensor, over some fifty of them. Of held values it is below kShort on average, as a tick seldom
/// comes between; of queued ones nearly 1. Longer intervals, as behind lost reports, tell nothing.
constexpr double kShort = 0.75;
constexpr double kHeldBelow = 0.85;
constexpr double kQueuedAbove = 0.97;
/// Share of new values among all reports: below, the sensor is at rest.
constexpr double kRestsBelow = 0.4;
constexpr double kShareGain = 0.02;
constexpr int kLearnReports = 50;

}  // namespace

DeviceClock::DeviceClock(const DeviceClockConfig& config)
    : config_(config), period_s_(config.nominal_period_s), tick_period_s_(config.sensor_period_s) {}

std::int64_t DeviceClock::Advance(std::int64_t received_ns, bool changed) {
  const std::int64_t before_ns = received_ns_;
  received_ns_ = received_ns;
  if (!started_ || received_ns - before_ns > Nanoseconds(config_.restart_s)) {
    started_ = true;
    loop_ns_ = received_ns;
    // The grid goes on over a pause: the sensor does.
    if (!held_) tick_ns_ = received_ns;
    sampled_ns_ = std::max(sampled_ns_, received_ns);
    return sampled_ns_;
  }
  changed_share_ += kShareGain * ((changed ? 1 : 0) - changed_share_);
  if (Seconds(received_ns - before_ns) < kShort * config_.sensor_period_s) {
    short_share_ += kShareGain * ((changed ? 1 : 0) - short_share_);
  }
  ++reports_;
  if (held_ ? short_share_ > kQueuedAbove : reports_ > kLearnReports && short_share_ < kHeldBelow) {
    held_ = !held_;
  }
  const std::int64_t loop_ns = AdvanceLoop(received_ns);
  const std::int64_t grid_ns = AdvanceGrid(before_ns, received_ns, changed);
  const std::int64_t estimate_ns = std::clamp(
      held_ ? grid_ns : loop_ns, received_ns - Nanoseconds(config_.max_lag_s), received_ns);
  sampled_ns_ = std::max(sampled_ns_, estimate_ns);
  return sampled_ns_;
}

std::int64_t DeviceClock::AdvanceLoop(std::int64_t received_ns) {
  const std::int64_t predicted_ns = loop_ns_ + Nanoseconds(period_s_);
  const double error_s = Seconds(received_ns - predicted_ns);
  const double gain = error_s < 0 ? config_.early_gain : config_.late_gain;
  std::int64_t estimate_ns = predicted_ns + Nanoseconds(gain * error_s);
  estimate_ns = std::clamp(estimate_ns, received_ns - Nanoseconds(config_.max_lag_s), received_ns);
  loop_ns_ = std::max(estimate_ns, loop_ns_);
  // What the estimate is moved by, all bounds included, is zero on average once the period is
  // right.
  const double moved_s = Seconds(loop_ns_ - predicted_ns);
  period_s_ =
      std::clamp(period_s_ + config_.period_gain * moved_s, config_.nominal_period_s / kPeriodRange,
                 config_.nominal_period_s * kPeriodRange);
  return loop_ns_;
}

std::int64_t DeviceClock::AdvanceGrid(std::int64_t before_ns, std::int64_t received_ns,
                                      bool changed) {
  const double ticks = std::floor(Seconds(received_ns - tick_ns_) / tick_period_s_);
  tick_ns_ += Nanoseconds(ticks * tick_period_s_);
  const std::int64_t period_ns = Nanoseconds(tick_period_s_);
  const bool moves = changed_share_ > kRestsBelow;
  const bool tick_between = tick_ns_ > before_ns;
  std::int64_t sampled_ns = tick_ns_;
  std::int64_t shift_ns = 0;  // Of the grid, to where it no longer contradicts.
  if (changed && !tick_between) {
    const std::int64_t forward_ns = before_ns - tick_ns_;
    const std::int64_t back_ns = tick_ns_ + period_ns - received_ns;
    shift_ns = back_ns < forward_ns ? -back_ns : forward_ns;
    sampled_ns = back_ns < forward_ns ? received_ns : before_ns;
  } else if (!changed && moves) {
    sampled_ns = sampled_ns_;
    if (tick_between && received_ns - before_ns < period_ns) {
      const std::int64_t forward_ns = received_ns - tick_ns_;
      const std::int64_t back_ns = tick_ns_ - before_ns;
      shift_ns = forward_ns < back_ns ? forward_ns : -back_ns;
    }
  }
  const double shift_s = Seconds(shift_ns);
  tick_ns_ += Nanoseconds(config_.phase_gain * shift_s);
  const double range_s = config_.held_period_range * config_.sensor_period_s;
  tick_period_s_ = std::clamp(tick_period_s_ + config_.held_period_gain * shift_s,
                              config_.sensor_period_s - range_s, config_.sensor_period_s + range_s);
  return sampled_ns;
}

}  // namespace footing::link
