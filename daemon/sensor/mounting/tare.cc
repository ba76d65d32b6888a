#include "daemon/sensor/mounting/tare.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/base/text.h"
#include "common/base/units.h"

namespace footing::tare {
namespace {

Tare Refused(std::string problem) {
  Tare tare;
  tare.problem = std::move(problem);
  return tare;
}

std::string OneDecimal(double value) { return text::Fixed(value, 1); }

double MeanTotal(std::span<const TareSample> samples) {
  double sum = 0;
  for (const TareSample& sample : samples) sum += Total(sample.forces);
  return sum / static_cast<double>(samples.size());
}

}  // namespace

Tare SolveTare(std::span<const TareSample> samples, double window_s, const TareConfig& config) {
  const std::size_t count = samples.size();
  if (count < 3 || static_cast<double>(count) < config.least_rate_hz * window_s) {
    return Refused("only " + std::to_string(count) + " samples in " + OneDecimal(window_s) +
                   " s; is the board awake, near enough, and its battery full?");
  }
  const double span_s =
      NanosecondsToSeconds(samples.back().sampled_ns - samples.front().sampled_ns);
  if (span_s < window_s - config.longest_gap_s) {
    return Refused("only " + OneDecimal(span_s) + " s of samples, " + OneDecimal(window_s) +
                   " are needed; wait and try again");
  }
  double longest_gap_s = 0;
  for (std::size_t i = 1; i < count; ++i) {
    const auto step_ns = samples[i].sampled_ns - samples[i - 1].sampled_ns;
    longest_gap_s = std::max(longest_gap_s, NanosecondsToSeconds(step_ns));
  }
  if (longest_gap_s > config.longest_gap_s) {
    return Refused("a gap of " + OneDecimal(longest_gap_s) + " s in its samples; try again");
  }
  Tare tare;
  board::CornerForces sum{0, 0, 0, 0};
  for (const TareSample& sample : samples) {
    sum.top_left_n += sample.forces.top_left_n;
    sum.top_right_n += sample.forces.top_right_n;
    sum.bottom_left_n += sample.forces.bottom_left_n;
    sum.bottom_right_n += sample.forces.bottom_right_n;
  }
  const double n = static_cast<double>(count);
  tare.offset = {sum.top_left_n / n, sum.top_right_n / n, sum.bottom_left_n / n,
                 sum.bottom_right_n / n};
  const double mean_n = Total(tare.offset);
  double squares = 0;
  for (const TareSample& sample : samples) {
    squares += (Total(sample.forces) - mean_n) * (Total(sample.forces) - mean_n);
  }
  tare.residual_n = std::sqrt(squares / n);
  if (std::abs(mean_n) > config.most_total_n) {
    return Refused("the load is " + OneDecimal(mean_n) + " N (" +
                   OneDecimal(NewtonsToKilograms(mean_n)) +
                   " kg), too much for an empty board; step off");
  }
  if (tare.residual_n > config.most_sd_n) {
    return Refused("the load moves by " + OneDecimal(tare.residual_n) +
                   " N; step off and leave the board alone");
  }
  const std::size_t third = count / 3;
  const double trend_n = MeanTotal(samples.last(third)) - MeanTotal(samples.first(third));
  if (std::abs(trend_n) > config.most_trend_n) {
    return Refused("the load drifts by " + OneDecimal(trend_n) +
                   " N; leave the board alone and try again");
  }
  tare.ok = true;
  return tare;
}

namespace {

constexpr std::int64_t kPauseNs = 250'000'000;

double Largest(const board::CornerForces& forces) {
  return std::max({std::abs(forces.top_left_n), std::abs(forces.top_right_n),
                   std::abs(forces.bottom_left_n), std::abs(forces.bottom_right_n)});
}

}  // namespace

bool Displacement::Advance(std::int64_t sampled_ns, const board::CornerForces& tared) {
  const double total_n = Total(tared);
  const bool quiet = started_ && Largest(tared - last_) <= config_.quiet_n;
  // A pause proves nothing about what happened in it.
  if (!started_ || sampled_ns - last_ns_ > kPauseNs) grounded_ns_ = level_ns_ = sampled_ns;
  started_ = true;
  last_ns_ = sampled_ns;
  last_ = tared;
  if (total_n > config_.lifted_n) grounded_ns_ = sampled_ns;
  const bool stands_otherwise =
      quiet && std::abs(total_n) <= config_.empty_n && Largest(tared) > config_.corner_n;
  if (!stands_otherwise) level_ns_ = sampled_ns;
  const auto since_s = [sampled_ns](std::int64_t then_ns) {
    return NanosecondsToSeconds(sampled_ns - then_ns);
  };
  moved_ =
      moved_ || since_s(grounded_ns_) >= config_.lifted_s || since_s(level_ns_) >= config_.rests_s;
  return moved_;
}

}  // namespace footing::tare
