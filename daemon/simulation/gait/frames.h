#pragma once

#include <Eigen/Core>
#include <cmath>

namespace footing::gait {

/// Heading frame H: the world turned about z so that x points where the character is to go.
inline Eigen::Vector3d ToHeading(double heading_rad, const Eigen::Vector3d& a_W) {
  const double c = std::cos(heading_rad), s = std::sin(heading_rad);
  return {c * a_W.x() + s * a_W.y(), -s * a_W.x() + c * a_W.y(), a_W.z()};
}

inline Eigen::Vector3d ToWorld(double heading_rad, const Eigen::Vector3d& a_H) {
  return ToHeading(-heading_rad, a_H);
}

}  // namespace footing::gait
