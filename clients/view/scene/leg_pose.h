#pragma once

#include <Eigen/Geometry>

namespace footing::scene {

/// Each of the drawn leg's two segments. The telescoping leg is 0.55 m to 1.15 m long, so two
/// segments of 0.60 m always reach.
inline constexpr double kLegSegmentM = 0.60;

/// A bird's leg drawn over a telescoping one: hip, backward-bending ankle, foot, in W.
struct LegPose {
  Eigen::Vector3d hip_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d ankle_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d foot_m = Eigen::Vector3d::Zero();
};

/// Puts the ankle sqrt(a^2 - (l/2)^2) behind the middle of the line from hip to foot, within the
/// leg's pitch plane; a = kLegSegmentM, l = |foot - hip|. `forward` is the leg's pitch-plane
/// direction; need not be of length 1 nor square to the leg. A leg longer than 2 a, which the
/// physics never makes, is drawn straight from the hip with the foot where it is.
LegPose SolveLeg(const Eigen::Vector3d& hip_m, const Eigen::Vector3d& foot_m,
                 const Eigen::Vector3d& forward);

}  // namespace footing::scene
