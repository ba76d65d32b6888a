#include "daemon/sensor/features/cycle.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

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

Inclination InclinationOf(const Eigen::Vector3d& gravity_mps2) {
  const auto angle = [](double along_mps2) {
    return std::asin(std::clamp(along_mps2 / kStandardGravityMps2, -1.0, 1.0));
  };
  return {angle(gravity_mps2.x()), angle(gravity_mps2.y())};
}

}  // namespace footing::features
