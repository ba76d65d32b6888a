#pragma once

#include <Eigen/Geometry>

namespace footing::arms {

/// The rotation about a vector's direction by its length, rad.
inline Eigen::Matrix3d Turned(const Eigen::Vector3d& angle_rad) {
  const double norm_rad = angle_rad.norm();
  if (norm_rad < 1e-12) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(norm_rad, angle_rad / norm_rad).toRotationMatrix();
}

}  // namespace footing::arms
