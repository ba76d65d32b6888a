#include "clients/view/scene/leg_pose.h"

#include <algorithm>
#include <cmath>

namespace footing::scene {
namespace {

constexpr double kTiny = 1e-9;

/// The part of `forward` square to `along`, of length 1; any square direction if there is none.
Eigen::Vector3d Across(const Eigen::Vector3d& along, const Eigen::Vector3d& forward) {
  const Eigen::Vector3d across = forward - forward.dot(along) * along;
  if (across.norm() > kTiny) return across.normalized();
  return along.unitOrthogonal();
}

}  // namespace

LegPose SolveLeg(const Eigen::Vector3d& hip_m, const Eigen::Vector3d& foot_m,
                 const Eigen::Vector3d& forward) {
  const Eigen::Vector3d line_m = foot_m - hip_m;
  const double length_m = line_m.norm();
  const Eigen::Vector3d along =
      length_m > kTiny ? Eigen::Vector3d(line_m / length_m) : Eigen::Vector3d(0, 0, -1);
  const double half_m = length_m / 2;
  const double behind_m = std::sqrt(std::max(0.0, kLegSegmentM * kLegSegmentM - half_m * half_m));
  return {hip_m, hip_m + half_m * along - behind_m * Across(along, forward), foot_m};
}

}  // namespace footing::scene
