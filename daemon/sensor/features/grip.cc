#include "daemon/sensor/features/grip.h"

#include <algorithm>
#include <cmath>

#include "common/base/units.h"
#include "daemon/sensor/features/cycle.h"

namespace footing::features {
namespace {

/// Across the front.
std::complex<double> Across(const Eigen::Vector3d& gravity_mps2) {
  return {gravity_mps2.x(), gravity_mps2.z()};
}

/// Into the mean of the last `horizon_s`, of which `seen_s` are known.
void Take(const std::complex<double>& value, double elapsed_s, double horizon_s,
          std::complex<double>& mean, double& seen_s) {
  if (!(elapsed_s > 0)) return;
  seen_s = std::min(seen_s + elapsed_s, horizon_s);
  mean += elapsed_s / seen_s * (value - mean);
}

}  // namespace

bool MeanRepeats(const SampleGrid& grid, double steps, const GripConfig& config) {
  const int late = static_cast<int>(std::lround(steps));
  if (late + static_cast<int>(std::floor(steps)) + 2 > grid.size()) return false;
  const std::complex<double> newest = Across(CycleMean(grid, 0, steps).transpose());
  const std::complex<double> before = Across(CycleMean(grid, late, steps).transpose());
  return std::abs(newest - before) <= config.most_change * std::abs(newest);
}

Eigen::Matrix3d PairGrip::FromRight() const {
  const double size = std::abs(turn_m2ps4);
  if (seen_s == 0 || !(size > 0)) return Eigen::Matrix3d::Identity();
  const double cosine = turn_m2ps4.real() / size, sine = turn_m2ps4.imag() / size;
  Eigen::Matrix3d rotation;
  rotation << cosine, 0, -sine, 0, 1, 0, sine, 0, cosine;
  return rotation;
}

PairGrip Next(const PairGrip& before, const std::optional<Eigen::Vector3d>& left_mps2,
              const std::optional<Eigen::Vector3d>& right_mps2, bool rests, double elapsed_s,
              const GripConfig& config) {
  if (!left_mps2 || !right_mps2) return before;
  const std::complex<double> left = Across(*left_mps2), right = Across(*right_mps2);
  const double least_mps2 = config.least_across * kStandardGravityMps2;
  if (std::min(std::abs(left), std::abs(right)) < least_mps2) return before;
  const std::complex<double> turn_m2ps4 = left * std::conj(right);
  PairGrip next = before;
  if (!rests) {
    next.rest_s = 0;
    Take(turn_m2ps4, elapsed_s, config.horizon_s, next.turn_m2ps4, next.seen_s);
    return next;
  }
  Take(turn_m2ps4, elapsed_s, config.rest_s, next.rest_m2ps4, next.rest_s);
  if (next.seen_s > config.rest_s || next.rest_s < config.rest_s) return next;
  next.turn_m2ps4 = next.rest_m2ps4;
  next.seen_s = config.rest_s;
  return next;
}

}  // namespace footing::features
