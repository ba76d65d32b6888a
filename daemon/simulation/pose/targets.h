#pragma once

#include <Eigen/Core>
#include <array>

#include "common/body/kinematics.h"

namespace footing::pose {

/// A point of the body that is known to be somewhere in W, or from the origin of another joint.
struct PointTarget {
  int joint = 0;                                    ///< Whose frame it is fixed to.
  Eigen::Vector3d p_J_m = Eigen::Vector3d::Zero();  ///< In that frame.
  Eigen::Vector3d p_W_m = Eigen::Vector3d::Zero();  ///< Where it should be.
  Eigen::Vector3d sd_m = Eigen::Vector3d::Ones();   ///< Along W's axes, positive.
  int from_joint = -1;  ///< p_W_m is the way from there to the point, along W's axes; -1: from W.
};

/// Where it is in a pose, in the same terms as p_W_m.
inline Eigen::Vector3d PlaceOf(const PointTarget& point, const body::Kinematics& at) {
  const auto joint = static_cast<std::size_t>(point.joint);
  const Eigen::Vector3d place_m = at.p_WJ[joint] + at.R_WJ[joint] * point.p_J_m;
  if (point.from_joint < 0) return place_m;
  return place_m - at.p_WJ[static_cast<std::size_t>(point.from_joint)];
}

inline constexpr int kMaxPoints = 16;

/// What one frame's pose is solved for: the terms of equation (6), each with its standard
/// deviation. What is not valid is not asked for.
struct PoseTargets {
  std::array<PointTarget, kMaxPoints> points;
  int count = 0;

  bool has_com = false;
  Eigen::Vector3d com_W_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d com_sd_m = Eigen::Vector3d::Ones();

  bool has_angular = false;                             ///< Needs a pose before.
  Eigen::Vector3d angular_W = Eigen::Vector3d::Zero();  ///< kg m^2/s.
  Eigen::Vector3d angular_sd = Eigen::Vector3d::Ones();

  void Add(const PointTarget& point) {
    if (count < kMaxPoints) points[static_cast<std::size_t>(count++)] = point;
  }
};

}  // namespace footing::pose
