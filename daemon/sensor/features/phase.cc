#include "daemon/sensor/features/phase.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>

#include "common/base/units.h"

namespace footing::features {
namespace {

constexpr int kHarmonics = 3;
constexpr int kTrials = 72;
using Spectrum = std::array<Eigen::Vector3cd, kHarmonics>;
using Cross = std::array<std::complex<double>, kHarmonics>;

/// Fourier coefficients of the cycle that ends `late` grid points before the newest.
Spectrum CycleSpectrum(const SampleGrid& grid, int late, double steps) {
  const Eigen::ArrayXd weights = CycleWeights(steps);
  const int count = static_cast<int>(weights.size());
  const auto samples = grid.Filtered(count + late).topRows(count);
  const Eigen::RowVector3d mean = CycleMean(grid, late, steps);
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

/// While both wrists twist, gravity moves alike in both sensors, and would make hands that swing in
/// turns look as if they swung together. The cycle's mean then moves along the way of the twist:
/// what the swing has across it decides, if that is enough.
Spectrum WithoutTwist(const Spectrum& spectrum, const SampleGrid& grid, int late, double steps,
                      const PhaseConfig& config) {
  const int before = late + static_cast<int>(std::lround(steps));
  if (static_cast<int>(std::floor(steps)) + 2 + before > grid.size()) return spectrum;
  const Eigen::Vector3d drift =
      (CycleMean(grid, late, steps) - CycleMean(grid, before, steps)).transpose();
  if (!(drift.norm() > config.twist_share * std::sqrt(Energy(spectrum)))) return spectrum;
  // The mean of a hand that has just begun to swing moves, too.
  const double energy_before = Energy(CycleSpectrum(grid, before, steps));
  if (energy_before < config.least_before_share * Energy(spectrum)) return spectrum;
  const Eigen::Vector3cd way = drift.normalized().cast<std::complex<double>>();
  Spectrum across = spectrum;
  for (auto& harmonic : across) harmonic -= way * way.dot(harmonic);
  return Energy(across) < config.least_across_share * Energy(spectrum) ? spectrum : across;
}

/// Rc at the lag at which the left one's angle is `phase_rad`.
double CrossCorrelation(const Cross& cross, double phase_rad) {
  double sum = 0;
  for (int h = 0; h < kHarmonics; ++h) {
    sum += (cross[h] * std::polar(1.0, -(h + 1) * phase_rad)).real();
  }
  return sum;
}

/// The angle of the highest value: the best of evenly spaced ones, then by parabolas around it.
double PeakAngle(const Cross& cross) {
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

/// Rc of two spectra of this common size, at its peak.
PhaseEstimate PeakOf(const Spectrum& left, const Spectrum& right, const PhaseConfig& config) {
  const double size = std::sqrt(Energy(left) * Energy(right));
  if (!(size > 0)) return {};
  Cross cross;
  // Eigen's dot conjugates its left side: the angle of `cross` is right minus left.
  for (int h = 0; h < kHarmonics; ++h) cross[h] = left[h].dot(right[h]) / size;
  const double phase_rad = PeakAngle(cross);
  const double correlation = CrossCorrelation(cross, phase_rad);
  return {correlation >= config.least_correlation, phase_rad, std::min(1.0, correlation)};
}

Spectrum Turned(const Spectrum& spectrum, const Eigen::Matrix3d& rotation) {
  Spectrum turned;
  for (int h = 0; h < kHarmonics; ++h) {
    turned[h] = rotation.cast<std::complex<double>>() * spectrum[h];
  }
  return turned;
}

/// The spectrum in the axes along the horizontal swing, across it and up: however the controller
/// is turned about the vertical, or inclined. False when the swing has no such direction, or when
/// its end is not known.
bool Align(const SampleGrid& grid, int late, double steps, const SwingEnd& end,
           const CycleConfig& cycle, Spectrum& spectrum) {
  const int count = static_cast<int>(std::floor(steps)) + 2;
  const Eigen::Vector3d mean = CycleMean(grid, late, steps).transpose();
  const SwingLine line = FindSwing(grid.Filtered(count + late).topRows(count), mean, cycle);
  if (!line.valid || !Next(end, line, cycle).known) return false;
  const SwingLine swing = Continued(line, end, cycle);
  Eigen::Matrix3d axes;
  axes << swing.along.transpose(), swing.up.cross(swing.along).transpose(), swing.up.transpose();
  for (auto& harmonic : spectrum) harmonic = axes.cast<std::complex<double>>() * harmonic;
  return true;
}

}  // namespace

PhaseEstimate FindPhase(const SampleGrid& left, const SampleGrid& right, double period_s,
                        const Eigen::Matrix3d& from_right, const SwingEnd& left_end,
                        const SwingEnd& right_end, const PhaseConfig& config,
                        const CycleConfig& cycle) {
  const double steps = period_s * kGridHz;
  const auto common = std::min(left.newest_index(), right.newest_index());
  const auto late_left =
      static_cast<int>(std::min<std::int64_t>(left.newest_index() - common, kGridLength));
  const auto late_right =
      static_cast<int>(std::min<std::int64_t>(right.newest_index() - common, kGridLength));
  const int needed = static_cast<int>(std::floor(steps)) + 2;
  if (needed + late_left > left.size() || needed + late_right > right.size()) return {};
  Spectrum left_spectrum =
      WithoutTwist(CycleSpectrum(left, late_left, steps), left, late_left, steps, config);
  Spectrum right_spectrum =
      WithoutTwist(CycleSpectrum(right, late_right, steps), right, late_right, steps, config);
  const PhaseEstimate estimate = PeakOf(left_spectrum, Turned(right_spectrum, from_right), config);
  if (estimate.found) return estimate;
  if (!Align(left, late_left, steps, left_end, cycle, left_spectrum) ||
      !Align(right, late_right, steps, right_end, cycle, right_spectrum)) {
    return {};
  }
  return PeakOf(left_spectrum, right_spectrum, config);
}

Phase Next(const Phase& before, const PhaseEstimate& estimate, double period_s, double elapsed_s,
           const PhaseConfig& config) {
  const auto differs = [&](double from_rad) {
    return std::abs(WrapAngle(estimate.phase_rad - from_rad)) > config.jump_rad;
  };
  Phase next = before;
  if (!estimate.found) {
    next.jumping = false;
    next.lost_s += elapsed_s;
    return next.lost_s > config.hold_cycles * period_s ? Phase{} : next;
  }
  next.lost_s = 0;
  if (before.valid && differs(before.phase_rad)) {
    const bool same_candidate = before.jumping && !differs(before.candidate_rad);
    next.candidate_age_s = same_candidate ? before.candidate_age_s + elapsed_s : 0;
    next.candidate_rad = estimate.phase_rad;
    next.jumping = true;
    if (next.candidate_age_s < config.jump_persistence * period_s) return next;
  }
  return {true, estimate.phase_rad, 0, false, 0, 0};
}

}  // namespace footing::features
