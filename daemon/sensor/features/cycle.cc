#include "daemon/sensor/features/cycle.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include "common/base/units.h"

namespace footing::features {
namespace {

constexpr int kTerms = 7;  // Mean, fundamental, second and third harmonic.
using Terms = Eigen::Matrix<double, kTerms, 1>;
using Block = Eigen::Matrix<double, Eigen::Dynamic, 3>;

Terms TermsAt(double angle_rad) {
  Terms terms;
  terms << 1, std::cos(angle_rad), std::sin(angle_rad), std::cos(2 * angle_rad),
      std::sin(2 * angle_rad), std::cos(3 * angle_rad), std::sin(3 * angle_rad);
  return terms;
}

/// Fills the clipped points of one axis in. Round by round, a point at which the fit stays inside
/// the range counts as lying at its end (it lies there or beyond), the others do not count.
void FillClipped(const SampleGrid& grid, int axis, double radians_per_step,
                 const CycleConfig& config, Block& samples) {
  const int count = static_cast<int>(samples.rows());
  const Eigen::VectorXd seen = samples.col(axis);
  Eigen::VectorXd filled = seen;
  const auto clipped = [&](int row) {
    return (grid.ClippedAxes(count - 1 - row) & (1u << axis)) != 0;
  };
  Terms solution = Terms::Zero();
  for (int round = 0; round < config.fit_rounds; ++round) {
    Eigen::Matrix<double, kTerms, kTerms> normal = Eigen::Matrix<double, kTerms, kTerms>::Zero();
    Terms right = Terms::Zero();
    normal(3, 3) = normal(4, 4) = config.second_prior;
    normal(5, 5) = normal(6, 6) = config.third_prior;
    normal(0, 0) = normal(1, 1) = normal(2, 2) = 1e-9;
    for (int row = 0; row < count; ++row) {
      const Terms terms = TermsAt(radians_per_step * (row - count + 1));
      const bool inside = round > 0 && std::abs(terms.dot(solution)) < std::abs(seen(row));
      if (clipped(row) && !inside) continue;
      normal += terms * terms.transpose();
      right += terms * seen(row);
    }
    solution = normal.ldlt().solve(right);
    if (!solution.allFinite()) return;
  }
  for (int row = 0; row < count; ++row) {
    if (!clipped(row)) continue;
    const double value = TermsAt(radians_per_step * (row - count + 1)).dot(solution);
    const double sign = seen(row) < 0 ? -1.0 : 1.0;
    filled(row) = sign * std::max(sign * value, std::abs(seen(row)));
  }
  samples.col(axis) = filled;
}

double ClippedShare(const SampleGrid& grid, int axis, int count) {
  int clipped = 0;
  for (int back = 0; back < count; ++back) {
    if (grid.ClippedAxes(back) & (1u << axis)) ++clipped;
  }
  return static_cast<double>(clipped) / count;
}

double HalfPeakToPeak(const Block& samples, const Eigen::Vector3d& mean) {
  const Block centred = samples.rowwise() - mean.transpose();
  const Eigen::Matrix3d covariance = centred.transpose() * centred;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
  const Eigen::VectorXd along = centred * solver.eigenvectors().col(2);
  return 0.5 * (along.maxCoeff() - along.minCoeff());
}

}  // namespace

double ParabolaMinimum(double before, double middle, double after) {
  const double bend = before - 2 * middle + after;
  return bend > 0 ? std::clamp(0.5 * (before - after) / bend, -0.5, 0.5) : 0.0;
}

Eigen::ArrayXd CycleWeights(double steps) {
  const int whole = static_cast<int>(std::floor(steps));
  const double part = steps - whole;
  // Points 0 .. whole + 1 back from the newest; the oldest interval is cut to `part`, its value at
  // the cut lies on the line between its ends.
  Eigen::ArrayXd weights = Eigen::ArrayXd::Ones(whole + 2);
  weights(whole + 1) = 0.5;
  weights(1) = 0.5 + part * (1 - 0.5 * part);
  weights(0) = 0.5 * part * part;
  if (whole == 0) weights(1) = part * (1 - 0.5 * part);
  return weights;
}

Eigen::RowVector3d CycleMean(const SampleGrid& grid, int late, double steps) {
  const Eigen::ArrayXd weights = CycleWeights(steps);
  const int count = static_cast<int>(weights.size());
  return (weights / weights.sum()).matrix().transpose() *
         grid.Filtered(count + late).topRows(count);
}

Cycle NewestCycle(const SampleGrid& grid, double period_s, const CycleConfig& config) {
  Cycle cycle;
  const Eigen::ArrayXd weights = CycleWeights(period_s * kGridHz);
  const int count = static_cast<int>(weights.size());
  if (count > grid.size()) return cycle;
  cycle.valid = true;
  Block samples = grid.Raw(count);
  for (int axis = 0; axis < 3; ++axis) {
    const double share = ClippedShare(grid, axis, count);
    if (share == 0) continue;
    cycle.clipped = cycle.clipped || share > config.most_clipped;
    if (share <= config.most_clipped)
      FillClipped(grid, axis, 2 * kPi / (period_s * kGridHz), config, samples);
  }
  const Eigen::Vector3d mean = samples.transpose() * (weights / weights.sum()).matrix();
  cycle.amplitude_mps2 = HalfPeakToPeak(samples, mean);
  if (cycle.clipped) return cycle;
  cycle.mean_mps2 = mean;
  cycle.swing = FindSwing(samples, mean, config);
  return cycle;
}

SwingLine FindSwing(const Block& samples, const Eigen::Vector3d& mean_mps2,
                    const CycleConfig& config) {
  const Eigen::Vector3d up = mean_mps2.normalized();
  const Eigen::Vector3d level = Eigen::Vector3d::UnitX() - up.x() * up;
  if (!up.allFinite() || level.norm() < config.least_level) return {};
  const Eigen::Vector3d left = level.normalized();
  const Eigen::Vector3d front = left.cross(up);
  const Block centred = samples.rowwise() - mean_mps2.transpose();
  const Eigen::ArrayXd along_left = centred * left, along_front = centred * front;
  const auto count = static_cast<double>(samples.rows());
  const double left_squares = along_left.square().sum() / count;
  const double front_squares = along_front.square().sum() / count;
  const double product = (along_left * along_front).sum() / count;
  // The eigenvalues of the horizontal covariance are half the sum plus and minus the spread.
  const double sum = left_squares + front_squares;
  const double spread = std::hypot(left_squares - front_squares, 2 * product);
  if (std::sqrt(sum) < config.least_swing_mps2) return {};
  if (sum + spread < config.swing_ratio * (sum - spread)) return {};
  const double angle_rad = 0.5 * std::atan2(2 * product, front_squares - left_squares);
  return {true, angle_rad, std::cos(angle_rad) * front + std::sin(angle_rad) * left, up};
}

SwingLine Continued(const SwingLine& line, const SwingEnd& before, const CycleConfig& config) {
  const bool other = line.valid && before.known &&
                     std::abs(WrapAngle(line.angle_rad - before.angle_rad)) > kPi / 2;
  const double angle_rad = WrapAngle(line.angle_rad + kPi);
  if (!other || std::abs(angle_rad) > config.furthest_turned_rad) return line;
  return {true, angle_rad, -line.along, line.up};
}

SwingEnd Next(const SwingEnd& before, const SwingLine& line, const CycleConfig& config) {
  if (!line.valid) return before;
  const bool known = before.known || std::abs(line.angle_rad) <= config.most_turned_rad;
  return {known, Continued(line, before, config).angle_rad};
}

namespace {

/// Cosine of the elevation of the front from which gravity shows a rotation about it: a hanging
/// forearm is 10 to 20 degrees off the vertical.
constexpr double kLeastAcross = 0.15;

}  // namespace

Inclination InclinationOf(const Eigen::Vector3d& gravity_mps2) {
  const auto angle = [](double along_mps2) {
    return std::asin(std::clamp(along_mps2 / kStandardGravityMps2, -1.0, 1.0));
  };
  const double across_mps2 = std::hypot(gravity_mps2.x(), gravity_mps2.z());
  const bool level = across_mps2 > kLeastAcross * gravity_mps2.norm();
  return {angle(gravity_mps2.x()), angle(gravity_mps2.y()), level,
          level ? std::atan2(gravity_mps2.x(), -gravity_mps2.z()) : 0};
}

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

Eigen::ArrayXd PrintedCorrelation(const Block& one, const Block& other) {
  const Eigen::Index count = one.rows();
  Block weighted = one;
  // W(T - tp) is 0: its point is left out.
  const auto newest = static_cast<double>(count);
  weighted.array().colwise() *= Eigen::ArrayXd::LinSpaced(count, 1 / newest, 1);
  Eigen::ArrayXd curve(other.rows() - count + 1);
  for (Eigen::Index lag = 0; lag < curve.size(); ++lag) {
    curve(lag) = weighted.cwiseProduct(other.middleRows(other.rows() - count - lag, count)).sum();
  }
  return curve;
}

PhaseEstimate PhaseAsPrinted(const SampleGrid& left, const SampleGrid& right, double period_s) {
  const int cycle = static_cast<int>(std::lround(period_s * kGridHz));
  const std::int64_t common = std::min(left.newest_index(), right.newest_index());
  const std::int64_t late_left = left.newest_index() - common;
  const std::int64_t late_right = right.newest_index() - common;
  if (cycle < 2 || cycle + late_left > left.size() || 2 * cycle + late_right > right.size()) {
    return {};
  }
  Block one = left.Filtered(cycle + static_cast<int>(late_left)).topRows(cycle);
  Block other = right.Filtered(2 * cycle + static_cast<int>(late_right)).topRows(2 * cycle);
  one.rowwise() -= one.colwise().mean().eval();
  other.rowwise() -= other.bottomRows(cycle).colwise().mean().eval();
  const Eigen::ArrayXd curve = PrintedCorrelation(one, other);
  Eigen::Index best = 0;
  curve.maxCoeff(&best);
  auto lag = static_cast<double>(best);
  if (best > 0 && best < cycle) {
    lag += ParabolaMinimum(-curve(best - 1), -curve(best), -curve(best + 1));
  }
  return {true, WrapAngle(2 * kPi * lag / (period_s * kGridHz)), 0};
}

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
