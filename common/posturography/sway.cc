#include "common/posturography/sway.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numeric>
#include <utility>

#include <unsupported/Eigen/FFT>

#include "common/base/result.h"
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
      sway.ml.path_m += std::abs(to.x_m - from.x_m);
      sway.ap.path_m += std::abs(to.y_m - from.y_m);
      swept_m2 += 0.5 * std::abs((to.x_m - mean.x_m) * (from.y_m - mean.y_m) -
                                 (from.x_m - mean.x_m) * (to.y_m - mean.y_m));
    }
  }
  FOOTING_CHECK(sway.duration_s > 0);
  sway.mean_velocity_mps = sway.path_m / sway.duration_s;
  sway.ml.mean_velocity_mps = sway.ml.path_m / sway.duration_s;
  sway.ap.mean_velocity_mps = sway.ap.path_m / sway.duration_s;
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
  sway.ml.rms_m = std::sqrt(sums.xx / count);
  sway.ap.rms_m = std::sqrt(sums.yy / count);
  sway.rms_radial_m = std::sqrt((sums.xx + sums.yy) / count);
  sway.mean_distance_m = distances_m / count;
  sway.ml.range_m = most_x - least_x;
  sway.ap.range_m = most_y - least_y;

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

constexpr double kLowestPowerHz = 0.15, kHighestPowerHz = 5;  // Prieto 1996.
constexpr int kTapers = 8;
/// Below it the tapers are broader than the band's lower end.
constexpr double kLeastSpectrumS = 10;
/// Beyond it, 20 minutes at 50 Hz, spectra and entropies would take long.
constexpr std::size_t kMostSamples = 60'000;

/// One axis of a stretch, about its own mean.
std::vector<double> Centred(const std::vector<CopSample>& stretch, double CopSample::*axis) {
  double sum_m = 0;
  for (const CopSample& sample : stretch) sum_m += sample.*axis;
  const double mean_m = sum_m / static_cast<double>(stretch.size());
  std::vector<double> values;
  for (const CopSample& sample : stretch) values.push_back(sample.*axis - mean_m);
  return values;
}

/// Adds the mean of the tapered spectra of `values`, times their number. One-sided; the sum over
/// all frequencies times their distance is the variance.
void AddSpectrum(const std::vector<double>& values, double rate_hz, std::vector<double>& spectrum) {
  const std::size_t points = 2 * (spectrum.size() - 1);
  const auto count = static_cast<double>(values.size());
  Eigen::FFT<double> fft;
  fft.SetFlag(Eigen::FFT<double>::HalfSpectrum);
  std::vector<double> tapered(points);
  std::vector<std::complex<double>> transform;
  for (int taper = 1; taper <= kTapers; ++taper) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      tapered[i] = std::sqrt(2 / (count + 1)) *
                   std::sin(kPi * taper * static_cast<double>(i + 1) / (count + 1)) * values[i];
    }
    fft.fwd(transform, tapered);
    for (std::size_t i = 0; i < spectrum.size(); ++i) {
      spectrum[i] += 2 * std::norm(transform[i]) / rate_hz / kTapers * count;
    }
  }
}

/// Where the sum of the spectrum from `first` on reaches `share` of that up to `last`, in bins.
double BinOfShare(const std::vector<double>& sums, double share) {
  const double wanted = share * sums.back();
  const auto at = std::lower_bound(sums.begin(), sums.end(), wanted) - sums.begin();
  const auto i = static_cast<std::size_t>(at);
  const double before = i > 0 ? sums[i - 1] : 0;
  // A bin's power is spread over its width, half of it to either side.
  return static_cast<double>(i) - 0.5 + (wanted - before) / (sums[i] - before);
}

void MeasureSpectrum(const Stretches& stretches, double rate_hz, double CopSample::*axis,
                     AxisSway& sway) {
  std::size_t longest = 0;
  for (const auto& stretch : stretches) longest = std::max(longest, stretch.size());
  std::size_t points = 1;
  while (points < 4 * longest) points *= 2;  // Finer than the tapers' width.
  std::vector<double> spectrum(points / 2 + 1);
  double weight = 0;
  for (const auto& stretch : stretches) {
    const auto count = static_cast<double>(stretch.size());
    if (count < kLeastSpectrumS * rate_hz) continue;
    AddSpectrum(Centred(stretch, axis), rate_hz, spectrum);
    weight += count;
  }
  if (weight <= 0) return;
  const double bin_hz = rate_hz / static_cast<double>(points);
  const auto first = static_cast<std::size_t>(std::ceil(kLowestPowerHz / bin_hz));
  const auto last =
      std::min(spectrum.size() - 1, static_cast<std::size_t>(std::floor(kHighestPowerHz / bin_hz)));
  if (last <= first) return;
  std::vector<double> sums(last - first + 1);
  std::partial_sum(spectrum.begin() + static_cast<std::ptrdiff_t>(first),
                   spectrum.begin() + static_cast<std::ptrdiff_t>(last + 1), sums.begin());
  sway.power_m2 = sums.back() / weight * bin_hz;
  if (sums.back() <= 0) return;  // At rest.
  constexpr double kMedian = 0.5, k95 = 0.95;
  sway.median_frequency_hz = (static_cast<double>(first) + BinOfShare(sums, kMedian)) * bin_hz;
  sway.frequency95_hz = (static_cast<double>(first) + BinOfShare(sums, k95)) * bin_hz;
}

/// Pairs are counted among all places at which m + 1 values follow within one stretch. Sorted by
/// their first values, the partners of a place lie behind it and near.
std::optional<double> SampleEntropy(const Stretches& stretches, double tolerance_m,
                                    double CopSample::*axis) {
  std::vector<std::array<double, 3>> places;
  for (const auto& stretch : stretches) {
    for (std::size_t i = 0; i + 2 < stretch.size(); ++i) {
      places.push_back({stretch[i].*axis, stretch[i + 1].*axis, stretch[i + 2].*axis});
    }
  }
  std::sort(places.begin(), places.end());
  std::size_t alike = 0, alike_next = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    for (std::size_t j = i + 1; j < places.size() && places[j][0] - places[i][0] <= tolerance_m;
         ++j) {
      if (std::abs(places[j][1] - places[i][1]) > tolerance_m) continue;
      ++alike;
      if (std::abs(places[j][2] - places[i][2]) <= tolerance_m) ++alike_next;
    }
  }
  if (alike_next == 0) return std::nullopt;
  return std::log(static_cast<double>(alike) / static_cast<double>(alike_next));
}

void MeasureDynamics(const Stretches& stretches, double rate_hz, double CopSample::*axis,
                     AxisSway& sway) {
  MeasureSpectrum(stretches, rate_hz, axis, sway);
  constexpr double kTolerance = 0.2;  // Richman & Moorman 2000.
  if (sway.rms_m > 0) sway.sample_entropy = SampleEntropy(stretches, kTolerance * sway.rms_m, axis);
}

}  // namespace

double FQuantile95(double degrees) { return degrees / 2 * (std::pow(0.05, -2 / degrees) - 1); }

Sway Measure(const Stretches& stretches, double rate_hz) {
  Sway sway;
  ForEach(stretches, [&](const CopSample&) { ++sway.samples; });
  FOOTING_CHECK(sway.samples >= 3);
  const Mean mean = MeanPosition(stretches, sway.samples);
  MeasurePath(stretches, mean, sway);
  MeasureEllipse(MeasureSpread(stretches, mean, sway), sway);
  if (sway.mean_distance_m > 0) {
    sway.mean_frequency_hz = sway.mean_velocity_mps / (2 * kPi * sway.mean_distance_m);
  }
  if (rate_hz > 0 && sway.samples <= kMostSamples) {
    MeasureDynamics(stretches, rate_hz, &CopSample::x_m, sway.ml);
    MeasureDynamics(stretches, rate_hz, &CopSample::y_m, sway.ap);
  }
  return sway;
}

std::vector<NamedMeasure> Named(const Sway& sway) {
  constexpr double kMm = 1e3;
  constexpr double kMm2 = 1e6;
  const auto mm2 = [](const std::optional<double>& m2) {
    return m2 ? std::optional(*m2 * kMm2) : std::nullopt;
  };
  return {{"duration_s", sway.duration_s},
          {"path_length_mm", sway.path_m * kMm},
          {"path_ml_mm", sway.ml.path_m * kMm},
          {"path_ap_mm", sway.ap.path_m * kMm},
          {"mean_velocity_mm_s", sway.mean_velocity_mps * kMm},
          {"mean_velocity_ml_mm_s", sway.ml.mean_velocity_mps * kMm},
          {"mean_velocity_ap_mm_s", sway.ap.mean_velocity_mps * kMm},
          {"rms_ml_mm", sway.ml.rms_m * kMm},
          {"rms_ap_mm", sway.ap.rms_m * kMm},
          {"rms_radial_mm", sway.rms_radial_m * kMm},
          {"mean_distance_mm", sway.mean_distance_m * kMm},
          {"range_ml_mm", sway.ml.range_m * kMm},
          {"range_ap_mm", sway.ap.range_m * kMm},
          {"ellipse95_area_mm2", sway.ellipse95_prediction_m2 * kMm2},
          {"prediction_ellipse95_F_mm2", sway.ellipse95_prediction_m2 * kMm2},
          {"ellipse95_area_chi2_mm2", sway.ellipse95_chi_square_m2 * kMm2},
          {"ellipse95_area_prieto_F3_mm2", sway.ellipse95_prieto_m2 * kMm2},
          {"axis_major_sd_mm", sway.ellipse_axis_major_sd_m * kMm},
          {"axis_minor_sd_mm", sway.ellipse_axis_minor_sd_m * kMm},
          {"axis_major_angle_deg", RadiansToDegrees(sway.ellipse_angle_rad)},
          {"sway_area_mm2_s", sway.sway_area_rate_m2ps * kMm2},
          {"circle95_area_mm2", sway.circle95_m2 * kMm2},
          {"mean_frequency_hz", sway.mean_frequency_hz},
          {"power_ml_mm2", mm2(sway.ml.power_m2)},
          {"power_ap_mm2", mm2(sway.ap.power_m2)},
          {"median_frequency_ml_hz", sway.ml.median_frequency_hz},
          {"median_frequency_ap_hz", sway.ap.median_frequency_hz},
          {"frequency95_ml_hz", sway.ml.frequency95_hz},
          {"frequency95_ap_hz", sway.ap.frequency95_hz},
          {"sample_entropy_ml", sway.ml.sample_entropy},
          {"sample_entropy_ap", sway.ap.sample_entropy}};
}

}  // namespace footing::posturography
