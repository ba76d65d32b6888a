#include "daemon/offline/analysis/sway.h"

#include <algorithm>
#include <cmath>

#include "common/base/result.h"
#include "common/base/text.h"
#include "common/base/units.h"

namespace footing::posturography {
namespace {

/// 95 % quantile of chi-square with 2 degrees of freedom: -2 ln 0.05.
const double kChiSquare95 = -2.0 * std::log(0.05);
constexpr double kPrietoF = 3.00;          // F(0.95; 2, infinity), as printed in the paper.
constexpr double kOneSidedNormal = 1.645;  // 95 % of the normal distribution, as printed there.

template <typename Visit>
void ForEach(const Stretches& stretches, Visit visit) {
  for (const std::vector<CopSample>& stretch : stretches) {
    for (const CopSample& sample : stretch) visit(sample);
  }
}

struct Mean {
  double x_m = 0;
  double y_m = 0;
};

Mean MeanPosition(const Stretches& stretches, std::size_t count) {
  Mean mean;
  ForEach(stretches, [&](const CopSample& sample) {
    mean.x_m += sample.x_m;
    mean.y_m += sample.y_m;
  });
  return {mean.x_m / static_cast<double>(count), mean.y_m / static_cast<double>(count)};
}

void MeasurePath(const Stretches& stretches, const Mean& mean, Sway& sway) {
  double swept_m2 = 0;
  for (const std::vector<CopSample>& stretch : stretches) {
    if (!stretch.empty()) sway.duration_s += stretch.back().time_s - stretch.front().time_s;
    for (std::size_t i = 1; i < stretch.size(); ++i) {
      const CopSample& from = stretch[i - 1];
      const CopSample& to = stretch[i];
      sway.path_m += std::hypot(to.x_m - from.x_m, to.y_m - from.y_m);
      sway.path_x_m += std::abs(to.x_m - from.x_m);
      sway.path_y_m += std::abs(to.y_m - from.y_m);
      swept_m2 += 0.5 * std::abs((to.x_m - mean.x_m) * (from.y_m - mean.y_m) -
                                 (from.x_m - mean.x_m) * (to.y_m - mean.y_m));
    }
  }
  FOOTING_CHECK(sway.duration_s > 0);
  sway.mean_velocity_mps = sway.path_m / sway.duration_s;
  sway.mean_velocity_x_mps = sway.path_x_m / sway.duration_s;
  sway.mean_velocity_y_mps = sway.path_y_m / sway.duration_s;
  sway.sway_area_rate_m2ps = swept_m2 / sway.duration_s;
}

struct Squares {
  double xx = 0;
  double yy = 0;
  double xy = 0;
};

/// Everything that looks at distances from the mean; returns the sums of squares.
Squares MeasureSpread(const Stretches& stretches, const Mean& mean, Sway& sway) {
  Squares sums;
  double distances_m = 0;
  double least_x = 0, most_x = 0, least_y = 0, most_y = 0;
  ForEach(stretches, [&](const CopSample& sample) {
    const double x = sample.x_m - mean.x_m;
    const double y = sample.y_m - mean.y_m;
    sums.xx += x * x;
    sums.yy += y * y;
    sums.xy += x * y;
    distances_m += std::hypot(x, y);
    least_x = std::min(least_x, x);
    most_x = std::max(most_x, x);
    least_y = std::min(least_y, y);
    most_y = std::max(most_y, y);
  });
  const auto count = static_cast<double>(sway.samples);
  sway.rms_x_m = std::sqrt(sums.xx / count);
  sway.rms_y_m = std::sqrt(sums.yy / count);
  sway.rms_radial_m = std::sqrt((sums.xx + sums.yy) / count);
  sway.mean_distance_m = distances_m / count;
  sway.range_x_m = most_x - least_x;
  sway.range_y_m = most_y - least_y;

  double spread_m2 = 0;  // Squares about the mean distance, summed as such: no cancellation.
  ForEach(stretches, [&](const CopSample& sample) {
    const double distance = std::hypot(sample.x_m - mean.x_m, sample.y_m - mean.y_m);
    spread_m2 += (distance - sway.mean_distance_m) * (distance - sway.mean_distance_m);
  });
  const double radius_m = sway.mean_distance_m + kOneSidedNormal * std::sqrt(spread_m2 / count);
  sway.circle95_m2 = kPi * radius_m * radius_m;
  return sums;
}

void MeasureEllipse(const Squares& sums, Sway& sway) {
  const auto count = static_cast<double>(sway.samples);
  const double xx = sums.xx / (count - 1);
  const double yy = sums.yy / (count - 1);
  const double xy = sums.xy / (count - 1);
  const double root_det = std::sqrt(std::max(0.0, xx * yy - xy * xy));
  sway.ellipse95_chi_square_m2 = kPi * kChiSquare95 * root_det;
  sway.ellipse95_prieto_m2 = 2 * kPi * kPrietoF * root_det;
  sway.ellipse95_prediction_m2 = kPi * 2 * (count - 1) * (count + 1) / (count * (count - 2)) *
                                 FQuantile95(count - 2) * root_det;
  const double middle = (xx + yy) / 2;
  const double half_difference = std::hypot((xx - yy) / 2, xy);
  sway.ellipse_axis_major_sd_m = std::sqrt(middle + half_difference);
  sway.ellipse_axis_minor_sd_m = std::sqrt(std::max(0.0, middle - half_difference));
  sway.ellipse_angle_rad = half_difference > 0 ? std::atan2(2 * xy, xx - yy) / 2 : 0;
}

}  // namespace

double FQuantile95(double degrees) { return degrees / 2 * (std::pow(0.05, -2 / degrees) - 1); }

Sway Measure(const Stretches& stretches) {
  Sway sway;
  ForEach(stretches, [&](const CopSample&) { ++sway.samples; });
  FOOTING_CHECK(sway.samples >= 3);
  const Mean mean = MeanPosition(stretches, sway.samples);
  MeasurePath(stretches, mean, sway);
  MeasureEllipse(MeasureSpread(stretches, mean, sway), sway);
  if (sway.mean_distance_m > 0) {
    sway.mean_frequency_hz = sway.mean_velocity_mps / (2 * kPi * sway.mean_distance_m);
  }
  return sway;
}

std::vector<CopSample> Resample(std::span<const CopSample> samples, double rate_hz,
                                double window_s) {
  FOOTING_CHECK(!samples.empty() && rate_hz > 0 && window_s > 0);
  const double first_s = samples.front().time_s;
  const double last_s = samples.back().time_s;
  // A last time that rounding puts a hair beyond the end still counts.
  const auto count = static_cast<std::size_t>(std::floor((last_s - first_s) * rate_hz + 1e-6)) + 1;
  std::vector<CopSample> even(count);
  std::size_t begin = 0;  // The first sample whose interval of relevance reaches into the window.
  const auto until = [&](std::size_t i) {
    return i + 1 < samples.size() ? (samples[i].time_s + samples[i + 1].time_s) / 2 : last_s;
  };
  for (std::size_t k = 0; k < count; ++k) {
    const double time_s = first_s + static_cast<double>(k) / rate_hz;
    const double from_s = std::max(first_s, time_s - window_s / 2);
    const double to_s = std::min(last_s, time_s + window_s / 2);
    while (begin + 1 < samples.size() && until(begin) <= from_s) ++begin;
    double weight_s = 0, x = 0, y = 0;
    double start_s = from_s;
    for (std::size_t i = begin; i < samples.size() && start_s < to_s; ++i) {
      const double end_s = std::min(until(i), to_s);
      const double share_s = std::max(0.0, end_s - start_s);
      weight_s += share_s;
      x += share_s * samples[i].x_m;
      y += share_s * samples[i].y_m;
      start_s = std::max(start_s, end_s);
    }
    const bool any = weight_s > 0;
    even[k] = {time_s, any ? x / weight_s : samples[begin].x_m,
               any ? y / weight_s : samples[begin].y_m};
  }
  return even;
}

double MedianInterval(const Stretches& stretches) {
  std::vector<double> intervals;
  for (const std::vector<CopSample>& stretch : stretches) {
    for (std::size_t i = 1; i < stretch.size(); ++i) {
      intervals.push_back(stretch[i].time_s - stretch[i - 1].time_s);
    }
  }
  return text::Median(std::move(intervals));
}

namespace {

double MedianWeight(const std::vector<CornerSample>& samples, double least_n) {
  std::vector<double> totals;
  for (const CornerSample& sample : samples) {
    if (Total(sample.forces) >= least_n) totals.push_back(Total(sample.forces));
  }
  return text::Median(std::move(totals));
}

CopSample CentreOfPressure(const CornerSample& sample, const BoardShape& shape) {
  const board::PlatePoint at =
      board::CentreOfPressure(sample.forces, Total(sample.forces), shape.geometry);
  return {sample.time_s, at.x_m, at.y_m};
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

template <typename Sample>
double LongestInterval(const std::vector<Sample>& samples) {
  std::vector<CopSample> times(samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) times[i].time_s = samples[i].time_s;
  return std::max(kLongestIntervalS, 5 * MedianInterval({times}));
}

}  // namespace

Standing FindStanding(const std::vector<CornerSample>& samples, const BoardShape& shape) {
  Standing standing;
  standing.weight_n = MedianWeight(samples, shape.least_body_weight_n);
  if (standing.weight_n <= 0) return standing;
  const double least_n = shape.least_share_of_weight * standing.weight_n;
  const double longest_s = LongestInterval(samples);
  bool stood = false;
  for (const CornerSample& sample : samples) {
    const bool stands = Total(sample.forces) >= least_n;
    if (stands) Append(CentreOfPressure(sample, shape), longest_s, !stood, standing);
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

}  // namespace footing::posturography
