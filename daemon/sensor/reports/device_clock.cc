#include "daemon/sensor/reports/device_clock.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numeric>
#include <vector>

#include "common/base/units.h"

namespace footing::link {
namespace {

/// Intervals nearer to a period than this say nothing on the phase.
constexpr double kLongestPair = 0.9;
/// Weight of a repeat against a change: a device at rest repeats as well.
constexpr double kRepeatWeight = 0.5;
/// A fit is believed when it explains this share of the changes ...
constexpr double kExplained = 0.95;
/// ... which chance would not: standard deviations above what any phase explains.
constexpr double kSignificance = 7;
/// Fewer changes in the window cannot reach that: no fit is tried.
constexpr int kLeastChanges = 48;

/// Each stage of a search looks around the period found by the one before.
struct Stage {
  double window_share;  // 1
  double range;         // 1
  double step;          // 1
};
// The first step moves the phase by a sixth of a period over its window (100 Hz), the last by
// 1/250.
constexpr Stage kStages[] = {
    {0.2, 0, 1e-3}, {0.5, 1e-3, 2.5e-4}, {1, 2.5e-4, 6e-5}, {1, 6e-5, 1.5e-5}, {1, 1.5e-5, 5e-6}};
constexpr std::size_t kFirstFineStage = 3;

double Fraction(double x) { return x - std::floor(x); }

}  // namespace

SampleTicks::SampleTicks(const SampleTicksConfig& config)
    : config_(config), period_s_(config.nominal_period_s) {}

void SampleTicks::Add(std::int64_t received_ns, bool changed) {
  const std::int64_t before_ns = last_ns_;
  last_ns_ = received_ns;
  if (!started_) {
    started_ = true;
    begun_ns_ = fitted_ns_ = received_ns;
    return;
  }
  if (NanosecondsToSeconds(received_ns - before_ns) > config_.coast_s) {
    known_ = false;
    pairs_.clear();
    begun_ns_ = fitted_ns_ = received_ns;
    return;
  }
  if (NanosecondsToSeconds(received_ns - before_ns) < kLongestPair * config_.nominal_period_s) {
    pairs_.push_back({before_ns, received_ns, changed});
    // A bound against a device that floods; 200 reports a second fit into it.
    if (pairs_.size() > static_cast<std::size_t>(config_.window_s * 200)) pairs_.pop_front();
  }
  while (!pairs_.empty() &&
         NanosecondsToSeconds(received_ns - pairs_.front().to_ns) > config_.window_s) {
    pairs_.pop_front();
  }
  const bool full = NanosecondsToSeconds(received_ns - begun_ns_) > config_.window_s;
  const double refit_s = known_ && full ? config_.refit_s : config_.search_s;
  if (NanosecondsToSeconds(received_ns - fitted_ns_) < refit_s) return;
  fitted_ns_ = received_ns;
  Refit();
}

SampleTicks::Fit SampleTicks::At(double period_s, double window_s) const {
  std::array<double, kBins + 1> change{};
  double full = 0;
  Fit fit;
  fit.period_s = period_s;
  double expected = 0, variance = 0;
  const auto bin = [&](std::int64_t at_ns) {
    return static_cast<int>(Fraction(NanosecondsToSeconds(at_ns - last_ns_) / period_s) * kBins) %
           kBins;
  };
  for (auto pair = pairs_.rbegin(); pair != pairs_.rend(); ++pair) {
    if (NanosecondsToSeconds(last_ns_ - pair->from_ns) > window_s) break;
    const double weight = pair->changed ? 1 : -kRepeatWeight;
    // The tick is after the first arrival and not after the second.
    const int from = bin(pair->from_ns);
    const int to = bin(pair->to_ns);
    change[static_cast<std::size_t>(from)] += weight;
    change[static_cast<std::size_t>(to) + 1] -= weight;
    if (to < from) full += weight;
    const double share =
        std::min(1.0, NanosecondsToSeconds(pair->to_ns - pair->from_ns) / period_s);
    expected += weight * share;
    variance += weight * weight * share * (1 - share);
    fit.changes += pair->changed ? 1 : 0;
  }
  std::array<double, kBins> score{};
  double sum = full;
  for (std::size_t i = 0; i < kBins; ++i) score[i] = sum += change[i];
  const auto best = static_cast<int>(std::max_element(score.begin(), score.end()) - score.begin());
  fit.score = score[static_cast<std::size_t>(best)];
  // The middle of the phases that are as good as the best.
  const auto as_good = [&](int i) {
    return score[static_cast<std::size_t>((i + kBins) % kBins)] >= fit.score - 1e-9;
  };
  int low = best, high = best;
  while (high - low < kBins && as_good(low - 1)) --low;
  while (high - low < kBins && as_good(high + 1)) ++high;
  fit.phase = Fraction((0.5 * (low + high) + 0.5) / kBins);
  fit.phase_range = static_cast<double>(high - low + 1) / kBins;
  fit.significance = variance > 0 ? (fit.score - expected) / std::sqrt(variance) : 0;
  return fit;
}

SampleTicks::Fit SampleTicks::Search(std::size_t first_stage, double period_s) const {
  const double known_s = std::min(config_.window_s, NanosecondsToSeconds(last_ns_ - begun_ns_));
  Fit best = At(period_s, known_s);
  for (std::size_t i = first_stage; i < std::size(kStages); ++i) {
    const Stage& stage = kStages[i];
    const double range = i == 0 ? config_.period_range : stage.range;
    const int steps = static_cast<int>(std::lround(range / stage.step));
    const double window_s = stage.window_share * known_s;
    const double centre_s = best.period_s;
    best = At(centre_s, window_s);
    for (int k = -steps; k <= steps; ++k) {
      const Fit fit = At(centre_s * (1 + k * stage.step), window_s);
      if (fit.score > best.score) best = fit;
    }
  }
  return best;
}

bool SampleTicks::IsGood(const Fit& fit) const {
  if (fit.significance < kSignificance) return false;
  int explained = 0;
  for (const Pair& pair : pairs_) {
    if (!pair.changed) continue;
    const double from = NanosecondsToSeconds(pair.from_ns - last_ns_) / fit.period_s - fit.phase;
    const double to = NanosecondsToSeconds(pair.to_ns - last_ns_) / fit.period_s - fit.phase;
    constexpr double kSlack = 1.0 / kBins;
    explained += std::floor(to + kSlack) > std::floor(from - kSlack) ? 1 : 0;
  }
  return explained >= kExplained * fit.changes;
}

void SampleTicks::Refit() {
  Fit fit;
  bool good = false;
  const auto changes =
      std::count_if(pairs_.begin(), pairs_.end(), [](const Pair& pair) { return pair.changed; });
  if (changes < kLeastChanges) {
    known_ = known_ && NanosecondsToSeconds(last_ns_ - proved_ns_) < config_.coast_s;
    return;
  }
  if (known_) {
    fit = Search(kFirstFineStage, period_s_);
    good = IsGood(fit);
  }
  if (!good) {
    fit = Search(0, config_.nominal_period_s);
    good = IsGood(fit);
  }
  if (!good) {
    known_ = known_ && NanosecondsToSeconds(last_ns_ - proved_ns_) < config_.coast_s;
    return;
  }
  known_ = true;
  proved_ns_ = last_ns_;
  period_s_ = fit.period_s;
  phase_range_ = fit.phase_range;
  tick_ns_ = last_ns_ + RoundToNanoseconds((fit.phase - 1) * fit.period_s);
}

double SampleTicks::phase_sd_s() const { return phase_range_ * period_s_ / std::sqrt(12); }

std::int64_t SampleTicks::TickBefore(std::int64_t at_ns) const {
  const double periods = std::floor(NanosecondsToSeconds(at_ns - tick_ns_) / period_s_);
  return std::min<std::int64_t>(at_ns, tick_ns_ + RoundToNanoseconds(periods * period_s_));
}

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
  // The estimate's corrections, all bounds included, are zero on average once the period is
  // right.
  const double moved_s = NanosecondsToSeconds(loop_ns_ - predicted_ns);
  period_s_ =
      std::clamp(period_s_ + config_.period_gain * moved_s, config_.nominal_period_s / kPeriodRange,
                 config_.nominal_period_s * kPeriodRange);
}

namespace {

constexpr std::size_t kOwnSeconds = 10;
/// Until so many are over the rates are taken to be equal.
constexpr std::size_t kLeastOwnSeconds = 2;

}  // namespace

void OwnClock::Take(std::int64_t received_ns, std::int64_t own_ns) {
  const std::int64_t difference_ns = received_ns - own_ns;
  const auto difference_of = [](const Fastest& one) { return one.received_ns - one.own_ns; };
  if (!seconds_.empty() && std::abs(difference_ns - difference_of(seconds_.back())) > kJumpNs) {
    seconds_.clear();
  }
  if (seconds_.empty() || received_ns - seconds_.back().from_ns >= kNanosecondsPerSecond) {
    seconds_.push_back({received_ns, received_ns, own_ns});
    if (seconds_.size() > kOwnSeconds + 1) seconds_.pop_front();
    Fit();
  } else if (Fastest& newest = seconds_.back(); difference_ns < difference_of(newest)) {
    newest = {newest.from_ns, received_ns, own_ns};
    Fit();
  }
}

/// How far behind the line through the oldest point one came, s.
double OwnClock::Behind(const Fastest& one, double rate) const {
  const Fastest& oldest = seconds_.front();
  return NanosecondsToSeconds(one.received_ns - oldest.received_ns) -
         rate * NanosecondsToSeconds(one.own_ns - oldest.own_ns);
}

/// The nearest line below all points goes through two of them, or is as steep as a line may be.
/// The second that is not over yet has no say in how steep: its first reports may all be late.
void OwnClock::Fit() {
  const std::size_t over = seconds_.size() - 1;
  std::vector<double> rates = {1};
  if (over >= kLeastOwnSeconds) rates = {1 - rate_range_, 1, 1 + rate_range_};
  for (std::size_t j = 1; j < over; ++j) {
    for (std::size_t i = 0; i < j; ++i) {
      const double own_s = NanosecondsToSeconds(seconds_[j].own_ns - seconds_[i].own_ns);
      const double host_s = NanosecondsToSeconds(seconds_[j].received_ns - seconds_[i].received_ns);
      if (std::abs(host_s - own_s) <= rate_range_ * own_s) rates.push_back(host_s / own_s);
    }
  }
  double nearest_s = std::numeric_limits<double>::infinity();
  for (const double rate : rates) {
    std::vector<double> behind_s;
    for (const Fastest& one : seconds_) behind_s.push_back(Behind(one, rate));
    const auto lowest = std::min_element(behind_s.begin(), behind_s.end());
    const double away_s = std::accumulate(behind_s.begin(), behind_s.end() - 1, 0.0) -
                          static_cast<double>(over) * *lowest;
    if (away_s >= nearest_s) continue;
    nearest_s = away_s;
    rate_ = rate;
    const Fastest& on_line = seconds_[static_cast<std::size_t>(lowest - behind_s.begin())];
    own_ns_ = on_line.own_ns;
    host_ns_ = on_line.received_ns;
  }
}

std::int64_t OwnClock::HostNs(std::int64_t own_ns) const {
  return host_ns_ + RoundToNanoseconds(rate_ * NanosecondsToSeconds(own_ns - own_ns_));
}

double OwnClock::sampled_sd_s() const {
  if (seconds_.size() <= kLeastOwnSeconds) return -1;
  double square_s2 = 0;
  for (auto one = seconds_.begin(); one + 1 != seconds_.end(); ++one) {
    const double behind_s = NanosecondsToSeconds(one->received_ns - HostNs(one->own_ns));
    square_s2 += behind_s * behind_s;
  }
  return std::sqrt(square_s2 / static_cast<double>(seconds_.size() - 1));
}

namespace {

constexpr double kTimeConstantS = 1;
constexpr double kGapPeriods = 5;

}  // namespace

void LinkStatistics::Advance(std::int64_t received_ns) {
  ++reports_;
  const double interval_s = NanosecondsToSeconds(received_ns - last_ns_);
  last_ns_ = received_ns;
  if (reports_ == 1) return;
  if (interval_s > kGapPeriods * nominal_period_s_) ++gaps_;
  if (reports_ == 2) {
    mean_s_ = interval_s;
    return;
  }
  const double weight = nominal_period_s_ / kTimeConstantS;
  const double error_s = interval_s - mean_s_;
  mean_s_ += weight * error_s;
  variance_s2_ += weight * (error_s * error_s - variance_s2_);
}

double LinkStatistics::RateHz(std::int64_t now_ns) const {
  const bool silent = now_ns - last_ns_ > kNanosecondsPerSecond;
  return silent || mean_s_ <= 0 ? 0 : 1 / mean_s_;
}

double LinkStatistics::JitterMs() const { return std::sqrt(variance_s2_) * 1e3; }

}  // namespace footing::link
