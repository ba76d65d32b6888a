#pragma once

#include <Eigen/Geometry>
#include <numbers>

#include "common/board/layout.h"
#include "common/camera/camera_pose.h"
#include "common/virtual/devices/noise.h"

/// A camera in front of two boards, and what it sees of a sphere on them.
namespace footing::camera_pose {

inline constexpr double kRadiusM = 0.0225;

/// At `p_W_m`, looking at a point over the origin.
inline Eigen::Isometry3d LookingAtTheBoards(const Eigen::Vector3d& p_W_m) {
  const Eigen::Vector3d forward = (Eigen::Vector3d(0, 0, 0.6) - p_W_m).normalized();
  const Eigen::Vector3d right = forward.cross(Eigen::Vector3d::UnitZ()).normalized();
  Eigen::Isometry3d X_WC = Eigen::Isometry3d::Identity();
  X_WC.linear() << right, forward.cross(right), forward;
  X_WC.translation() = p_W_m;
  return X_WC;
}

inline const Eigen::Isometry3d kTrue = LookingAtTheBoards({2.1, 0.4, 1.3});

/// Covariance of a camera: 0.1 mm across the line of sight, 4 mm along it at 2 m.
inline Eigen::Matrix3d CameraNoise(const Eigen::Vector3d& p_C_m) {
  const Eigen::Vector3d along = p_C_m.normalized();
  return 1e-8 * Eigen::Matrix3d::Identity() +
         std::pow(1e-3 * p_C_m.squaredNorm(), 2) * along * along.transpose();
}

inline Eigen::Vector3d Normal3(noise::Random& random) {
  return {random.Normal(), random.Normal(), random.Normal()};
}

inline SeenPoint SeenAt(const Eigen::Isometry3d& X_WC, const Eigen::Vector3d& p_W_m) {
  const Eigen::Vector3d p_C_m = X_WC.inverse() * p_W_m;
  return {p_C_m, CameraNoise(p_C_m)};
}

/// Without noise.
inline Observations Seen(const Eigen::Isometry3d& X_WC) {
  Observations observations;
  for (const Mark& mark : BoardMarks(board::DefaultLayout(), kRadiusM))
    observations.marks.push_back({mark, SeenAt(X_WC, mark.p_W_m)});
  return observations;
}

}  // namespace footing::camera_pose
