#include "daemon/offline/pose_run/lift_off.h"

#include <cmath>

namespace footing::pose_run {
namespace {

constexpr double kInstantS = 1e-9;

}  // namespace

void LegScore::Add(const LegError& leg) {
  ++count_;
  for (std::size_t k = 0; k < kLegJoints; ++k) {
    const double variance_m2 = leg.sd_m[k] * leg.sd_m[k];
    square_m2_[k] += leg.error_m[k].squaredNorm();
    variance_m2_[k] += variance_m2;
    if (variance_m2 > 0) nees_[k] += leg.error_m[k].squaredNorm() / (3 * variance_m2);
  }
}

double LegScore::error_cm(std::size_t joint) const {
  return count_ > 0 ? 100 * std::sqrt(square_m2_[joint] / static_cast<double>(count_)) : 0;
}

double LegScore::sd_cm(std::size_t joint) const {
  return count_ > 0 ? 100 * std::sqrt(variance_m2_[joint] / static_cast<double>(count_)) : 0;
}

double LegScore::nees(std::size_t joint) const {
  return count_ > 0 ? nees_[joint] / static_cast<double>(count_) : 0;
}

double LegScore::nees() const {
  double sum = 0;
  for (std::size_t k = 0; k < kLegJoints; ++k) sum += nees(k);
  return sum / kLegJoints;
}

void LiftOffs::Add(std::size_t foot, double load_n, const Eigen::Vector3d& ankle_m,
                   const LegError& leg) {
  Foot& now = feet_[foot];
  const double speed_mps = now.started ? (ankle_m - now.ankle_m).norm() / step_s_ : 0;
  now.ankle_m = ankle_m;
  now.started = true;
  if (load_n > kLoadedN) {
    now.stood_s += step_s_;
    now.aloft = now.kicking = false;
    return;
  }
  if (now.aloft) {
    now.aloft_s += step_s_;
  } else if (now.stood_s > kStoodS - kInstantS) {
    now.aloft = true;
    now.aloft_s = 0;
    now.next = 0;
    ++count_;
  }
  now.stood_s = 0;
  if (!now.aloft) return;
  aloft_.Add(leg);
  if (now.next < kAfterS.size() && now.aloft_s > kAfterS[now.next] - kInstantS) {
    after_[now.next++].Add(leg);
  }
  const bool kicking = speed_mps > kKickMps;
  if (kicking) kick_.Add(leg);
  if (kicking && !now.kicking) ++kicks_;
  now.kicking = kicking;
}

}  // namespace footing::pose_run
