#include "common/posturography/standing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <Eigen/Core>

#include "common/base/low_pass.h"
#include "common/base/text.h"
#include "common/board/layout.h"

namespace footing::posturography {
namespace {

/// Values at times, as Resample averages them: one column a time.
struct Series {
  std::vector<double> times_s;
  Eigen::Matrix3Xd values;

  explicit Series(std::size_t count)
      : times_s(count), values(3, static_cast<Eigen::Index>(count)) {}
  void Set(std::size_t i, double time_s, const Eigen::Vector3d& value) {
    times_s[i] = time_s;
    values.col(static_cast<Eigen::Index>(i)) = value;
  }
};

/// Times from `from_s` on.
struct EvenTimes {
  double from_s = 0;
  double rate_hz = 0;
  std::size_t count = 0;

  /// Up to `to_s`; a last time that rounding puts a hair beyond the end still counts.
  EvenTimes(double first_s, double to_s, double rate)
      : from_s(first_s),
        rate_hz(rate),
        count(static_cast<std::size_t>(std::floor((to_s - first_s) * rate + 1e-6)) + 1) {}
  double At(std::size_t k) const { return from_s + static_cast<double>(k) / rate_hz; }
};

/// Means over a window around each time, weighted by interval of relevance.
Eigen::Matrix3Xd WindowMeans(const Series& series, const EvenTimes& even, double window_s) {
  const std::vector<double>& times_s = series.times_s;
  const double last_s = times_s.back();
  Eigen::Matrix3Xd means(3, static_cast<Eigen::Index>(even.count));
  std::size_t begin = 0;  // The first sample whose interval of relevance reaches into the window.
  const auto until = [&](std::size_t i) {
    return i + 1 < times_s.size() ? (times_s[i] + times_s[i + 1]) / 2 : last_s;
  };
  const auto value = [&](std::size_t i) { return series.values.col(static_cast<Eigen::Index>(i)); };
  for (std::size_t k = 0; k < even.count; ++k) {
    const double from_s = std::max(times_s.front(), even.At(k) - window_s / 2);
    const double to_s = std::min(last_s, even.At(k) + window_s / 2);
    while (begin + 1 < times_s.size() && until(begin) <= from_s) ++begin;
    double weight_s = 0, start_s = from_s;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t i = begin; i < times_s.size() && start_s < to_s; ++i) {
      const double end_s = std::min(until(i), to_s);
      const double share_s = std::max(0.0, end_s - start_s);
      weight_s += share_s;
      sum += share_s * value(i);
      start_s = std::max(start_s, end_s);
    }
    means.col(static_cast<Eigen::Index>(k)) =
        weight_s > 0 ? Eigen::Vector3d(sum / weight_s) : Eigen::Vector3d(value(begin));
  }
  return means;
}

template <typename Sample>
void AppendIntervals(const std::vector<Sample>& samples, std::vector<double>& intervals) {
  for (std::size_t i = 1; i < samples.size(); ++i) {
    intervals.push_back(samples[i].time_s - samples[i - 1].time_s);
  }
}

template <typename Sample>
double LongestInterval(const std::vector<Sample>& samples) {
  std::vector<double> intervals;
  AppendIntervals(samples, intervals);
  return std::max(kLongestIntervalS, 5 * text::Median(std::move(intervals)));
}

double MedianWeight(const Loads& loads, double least_n) {
  std::vector<double> totals;
  for (const LoadSample& sample : loads) {
    if (sample.load_n >= least_n) totals.push_back(sample.load_n);
  }
  return text::Median(std::move(totals));
}

/// Appends to the last stretch, or begins one after a gap or where `begin` says so.
void Append(const CopSample& sample, double longest_s, bool begin, Standing& standing) {
  Stretches& stretches = standing.stretches;
  ++standing.samples;
  if (begin || stretches.empty()) {
    stretches.push_back({sample});
    return;
  }
  const double interval_s = sample.time_s - stretches.back().back().time_s;
  if (interval_s > longest_s) {
    ++standing.gaps.count;
    standing.gaps.longest_s = std::max(standing.gaps.longest_s, interval_s);
    standing.gaps.seconds += interval_s;
    stretches.emplace_back();
  }
  stretches.back().push_back(sample);
}

}  // namespace

Loads LoadsOn(std::span<const CornerSample> samples, const stream::BoardPose& pose,
              const stream::BoardGeometry& geometry) {
  const auto places = board::SensorPlaces(pose, geometry);
  Loads loads;
  loads.reserve(samples.size());
  for (const CornerSample& sample : samples) {
    const board::CornerForces& f = sample.forces;
    const board::Corners forces = {f.top_left_n, f.top_right_n, f.bottom_left_n, f.bottom_right_n};
    LoadSample& load = loads.emplace_back();
    load.time_s = sample.time_s;
    for (std::size_t corner = 0; corner < forces.size(); ++corner) {
      load.load_n += forces[corner];
      load.right_nm -= forces[corner] * places[corner].y();
      load.front_nm += forces[corner] * places[corner].x();
    }
  }
  return loads;
}

Standing FindStanding(const Loads& loads, const StandingLimits& limits) {
  Standing standing;
  standing.weight_n = MedianWeight(loads, limits.least_body_weight_n);
  if (standing.weight_n <= 0) return standing;
  const double least_n = limits.least_share_of_weight * standing.weight_n;
  const double longest_s = LongestInterval(loads);
  bool stood = false;
  for (const LoadSample& load : loads) {
    const bool stands = load.load_n >= least_n;
    if (stands) {
      Append({load.time_s, load.right_nm / load.load_n, load.front_nm / load.load_n}, longest_s,
             !stood, standing);
    }
    stood = stands;
  }
  return standing;
}

Standing SplitAtGaps(const std::vector<CopSample>& samples) {
  Standing standing;
  const double longest_s = LongestInterval(samples);
  for (const CopSample& sample : samples) Append(sample, longest_s, false, standing);
  return standing;
}

std::vector<CopSample> Resample(std::span<const CopSample> samples, double rate_hz,
                                double window_s) {
  FOOTING_CHECK(!samples.empty() && rate_hz > 0 && window_s > 0);
  Series series(samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    series.Set(i, samples[i].time_s, {samples[i].x_m, samples[i].y_m, 0});
  }
  const EvenTimes even(series.times_s.front(), series.times_s.back(), rate_hz);
  const Eigen::Matrix3Xd means = WindowMeans(series, even, window_s);
  std::vector<CopSample> out(even.count);
  for (std::size_t k = 0; k < even.count; ++k) {
    const auto mean = means.col(static_cast<Eigen::Index>(k));
    out[k] = {even.At(k), mean.x(), mean.y()};
  }
  return out;
}

Loads Merged(const Loads& left, const Loads& right, double rate_hz, double window_s) {
  if (left.empty() || right.empty()) return {};
  const double first_s = std::max(left.front().time_s, right.front().time_s);
  const double last_s = std::min(left.back().time_s, right.back().time_s);
  if (last_s < first_s) return {};
  const EvenTimes even(first_s, last_s, rate_hz);
  Eigen::Matrix3Xd sums = Eigen::Matrix3Xd::Zero(3, static_cast<Eigen::Index>(even.count));
  std::vector<char> in_gap(even.count, 0);
  for (const Loads* loads : {&left, &right}) {
    Series series(loads->size());
    const double longest_s = LongestInterval(*loads);
    for (std::size_t i = 0; i < loads->size(); ++i) {
      const LoadSample& load = (*loads)[i];
      series.Set(i, load.time_s, {load.load_n, load.right_nm, load.front_nm});
      if (i == 0 || load.time_s - series.times_s[i - 1] <= longest_s) continue;
      for (std::size_t k = 0; k < even.count && even.At(k) < load.time_s; ++k) {
        if (even.At(k) > series.times_s[i - 1]) in_gap[k] = 1;
      }
    }
    sums += WindowMeans(series, even, window_s);
  }
  Loads merged;
  for (std::size_t k = 0; k < even.count; ++k) {
    const auto sum = sums.col(static_cast<Eigen::Index>(k));
    if (in_gap[k] == 0) merged.push_back({even.At(k), sum.x(), sum.y(), sum.z()});
  }
  return merged;
}

double MedianInterval(const Stretches& stretches) {
  std::vector<double> intervals;
  for (const auto& stretch : stretches) AppendIntervals(stretch, intervals);
  return text::Median(std::move(intervals));
}

double MedianInterval(const Loads& loads) {
  std::vector<double> intervals;
  AppendIntervals(loads, intervals);
  return text::Median(std::move(intervals));
}

double EvenRate(const Stretches& stretches) {
  const double median_s = MedianInterval(stretches);
  std::size_t intervals = 0;
  for (const auto& stretch : stretches) {
    for (std::size_t i = 1; i < stretch.size(); ++i, ++intervals) {
      const double interval_s = stretch[i].time_s - stretch[i - 1].time_s;
      if (std::abs(interval_s - median_s) > 0.01 * median_s) return 0;
    }
  }
  return median_s > 0 ? static_cast<double>(intervals) / DurationS(stretches) : 0;
}

double DurationS(const Stretches& stretches) {
  double duration_s = 0;
  for (const auto& stretch : stretches) {
    duration_s += stretch.back().time_s - stretch.front().time_s;
  }
  return duration_s;
}

namespace {

/// Advice of posturography: at least 50 Hz, and a low-pass at 10 Hz (Ruhe A et al., The
/// test-retest reliability of centre of pressure measures in bipedal static task conditions, Gait &
/// Posture 32(4), 2010; Scoppa F et al., Clinical stabilometry standardization, Gait & Posture
/// 37(2), 2013).
constexpr double kUsualRateHz = 50;
constexpr double kUsualCutoffHz = 10;
/// Above this share of the rate the low-pass leaves the signal as it is (LowPass).
constexpr double kHighestCutoffOfRate = 0.36;
constexpr double kLowestRateHz = 1;
constexpr double kLowestCutoffHz = 0.1;
constexpr double kHighestHz = 1000;
/// 55 hours at 100 Hz: a guard against times in another unit.
constexpr double kMostResampled = 2e7;

constexpr const char* kAsRecorded = "recorded";
constexpr const char* kNone = "none";

struct FrequencyOption {
  const char* name;
  const std::string& text;
  const char* off;  ///< The word for no such filter.
  double lowest_hz;
};

/// The option in Hz, 0 where it is off, or `usual_hz` where it is not given.
Result<double> FrequencyOf(const FrequencyOption& option, double usual_hz) {
  if (option.text.empty()) return usual_hz;
  if (option.text == option.off) return 0.0;
  const auto hz = text::ToNumber(option.text);
  if (hz && *hz >= option.lowest_hz && *hz <= kHighestHz) return *hz;
  return UsageError(std::string(option.name) + " " + option.text + ": give " +
                    text::Shortest(option.lowest_hz) + " to 1000 Hz, or " + option.off);
}

}  // namespace

double CopFilter::WindowS(double median_interval_s) const {
  return window_s > 0 ? window_s : std::max(2 / rate_hz, 2 * median_interval_s);
}

std::string CopFilter::Text() const {
  if (rate_hz <= 0) return kNone;
  std::string name = "SWARII window average (Audiffren & Contal 2016)";
  if (cutoff_hz > 0) name += ", then Butterworth low-pass of 4th order without lag";
  return name;
}

Result<CopFilter> CopFilterOf(const CopFilterOptions& words, bool corners) {
  const auto rate_hz = FrequencyOf({"--rate-hz", words.rate, kAsRecorded, kLowestRateHz},
                                   corners ? kUsualRateHz : 0);
  if (!rate_hz) return rate_hz.error();
  const double highest_hz = kHighestCutoffOfRate * *rate_hz;
  const double usual_hz = corners && kUsualCutoffHz <= highest_hz ? kUsualCutoffHz : 0;
  const auto cutoff_hz =
      FrequencyOf({"--cutoff-hz", words.cutoff, kNone, kLowestCutoffHz}, usual_hz);
  if (!cutoff_hz) return cutoff_hz.error();
  if (*cutoff_hz > 0 && *rate_hz <= 0) {
    return UsageError("--cutoff-hz needs an even rate: give --rate-hz HZ");
  }
  if (words.window_s > 0 && *rate_hz <= 0) {
    return UsageError("--window-s is the window of --rate-hz HZ: give one");
  }
  if (*cutoff_hz > highest_hz) {
    return UsageError("--cutoff-hz " + words.cutoff + " is above 0.36 of the rate of " +
                      std::to_string(std::lround(*rate_hz)) + " Hz: lower it, or raise --rate-hz");
  }
  return CopFilter{*rate_hz, *cutoff_hz, words.window_s};
}

Result<void> ResampleAll(const CopFilter& filter, Stretches& stretches) {
  if (filter.rate_hz <= 0) return {};
  const double duration_s = DurationS(stretches);
  if (duration_s * filter.rate_hz > kMostResampled) {
    return InvalidData("the recording lasts " + text::Fixed(duration_s, 0) +
                       " s, too long for --rate-hz; is its time in seconds?");
  }
  const double window_s = filter.WindowS(MedianInterval(stretches));
  for (auto& stretch : stretches) stretch = Resample(stretch, filter.rate_hz, window_s);
  return {};
}

void LowPassAll(const CopFilter& filter, Stretches& stretches) {
  if (filter.cutoff_hz <= 0) return;
  for (auto& stretch : stretches) {
    Eigen::MatrixXd signal(2, static_cast<Eigen::Index>(stretch.size()));
    for (std::size_t i = 0; i < stretch.size(); ++i) {
      signal.col(static_cast<Eigen::Index>(i)) << stretch[i].x_m, stretch[i].y_m;
    }
    signal = LowPass(signal, filter.rate_hz, filter.cutoff_hz);
    for (std::size_t i = 0; i < stretch.size(); ++i) {
      stretch[i].x_m = signal(0, static_cast<Eigen::Index>(i));
      stretch[i].y_m = signal(1, static_cast<Eigen::Index>(i));
    }
  }
}

}  // namespace footing::posturography
