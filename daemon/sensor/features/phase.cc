#include "daemon/sensor/features/phase.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>

#include "common/units/units.h"
#include "daemon/sensor/features/cycle.h"

namespace footing::features {
namespace {

constexpr int kHarmonics = 3;
constexpr int kTrials = 72;
using Spectrum = std::array<Eigen::Vector3cd, kHarmonics>;

/// Fourier coefficients of the cycle that ends `late` grid points before the newest.
Spectrum CycleSpectrum(const SampleGrid& grid, int late, double steps) {
  const Eigen::ArrayXd weights = CycleWeights(steps);
  const int count = static_cast<int>(weights.size());
  const auto samples = grid.Filtered(count + late).topRows(count);
  const Eigen::RowVector3d mean = (weights / weights.sum()).matrix().transpose() * samples;
  Spectrum spectrum;
  spectrum.fill(Eigen::Vector3cd::Zero());
  for (int row = 0; row < count; ++row) {
    const double angle = 2 * kPi * (row - count + 1) / steps;
    const Eigen::Vector3d value = weights(row) * (samples.row(row) - mean).transpose();
    for (int h = 0; h < kHarmonics; ++h) {
      spectrum[h] += std::polar(1.0, -(h + 1) * angle) * value.cast<std::complex<double>>();
    }
  }
  for (auto& harmonic : spectrum) harmonic *= 2.0 / steps;
  return spectrum;
}

double Energy(const Spectrum& spectrum) {
  double energy = 0;
  for (const auto& harmonic : spectrum) energy += harmonic.squaredNorm();
  return energy;
}

/// Rc at the lag at which the left one's angle is `phase_rad`.
double CrossCorrelation(const std::array<std::complex<double>, kHarmonics>& cross,
                        double phase_rad) {
  double sum = 0;
  for (int h = 0; h < kHarmonics; ++h) {
    sum += (cross[h] * std::polar(1.0, -(h + 1) * phase_rad)).real();
  }
  return sum;
}

/// The angle of the highest value: the best of evenly spaced ones, then by parabolas around it.
double PeakAngle(const std::array<std::complex<double>, kHarmonics>& cross) {
  double step = 2 * kPi / kTrials;
  double best = 0;
  for (int i = 1; i < kTrials; ++i) {
    if (CrossCorrelation(cross, i * step) > CrossCorrelation(cross, best)) best = i * step;
  }
  for (int round = 0; round < 3; ++round) {
    const double before = CrossCorrelation(cross, best - step);
    const double middle = CrossCorrelation(cross, best);
    const double after = CrossCorrelation(cross, best + step);
    const double bend = before - 2 * middle + after;
    if (bend < 0) best += std::clamp(0.5 * (before - after) / bend, -1.0, 1.0) * step;
    step *= 0.25;
  }
  return WrapAngle(best);
}

}  // namespace

PhaseEstimate FindPhase(const SampleGrid& left, const SampleGrid& right, double period_s,
                        const PhaseConfig& config) {
  const double steps = period_s * kGridHz;
  const auto common = std::min(left.newest_index(), right.newest_index());
  const auto late_left =
      static_cast<int>(std::min<std::int64_t>(left.newest_index() - common, kGridLength));
  const auto late_right =
      static_cast<int>(std::min<std::int64_t>(right.newest_index() - common, kGridLength));
  const int needed = static_cast<int>(std::floor(steps)) + 2;
  if (needed + late_left > left.size() || needed + late_right > right.size()) return {};
  const Spectrum left_spectrum = CycleSpectrum(left, late_left, steps);
  const Spectrum right_spectrum = CycleSpectrum(right, late_right, steps);
  const double size = std::sqrt(Energy(left_spectrum) * Energy(right_spectrum));
  if (!(size > 0)) return {};
  std::array<std::complex<double>, kHarmonics> cross;
  for (int h = 0; h < kHarmonics; ++h) {
    // Eigen's dot conjugates its left side: the angle of `cross` is right minus left.
    cross[h] = left_spectrum[h].dot(right_spectrum[h]) / size;
  }
  const double phase_rad = PeakAngle(cross);
  const double correlation = CrossCorrelation(cross, phase_rad);
  return {correlation >= config.least_correlation, phase_rad, std::min(1.0, correlation)};
}

Phase Next(const Phase& before, const PhaseEstimate& estimate, double period_s, double elapsed_s,
           const PhaseConfig& config) {
  if (estimate.found) return {true, estimate.phase_rad, 0};
  Phase next = before;
  next.lost_s += elapsed_s;
  return next.lost_s > config.hold_cycles * period_s ? Phase{} : next;
}

}  // namespace footing::features
