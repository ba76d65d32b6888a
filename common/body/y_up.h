#pragma once

#include <Eigen/Core>

#include "common/body/skeleton.h"

/// Motion files of animation have y up, z ahead and x to the left; W has x ahead, y left, z up. The
/// one turns into the other by a cyclic change of names, so rotations keep their angles.
namespace footing::body {

inline Eigen::Vector3d FromYUp(const Eigen::Vector3d& file) { return {file(2), file(0), file(1)}; }
inline Eigen::Vector3d ToYUp(const Eigen::Vector3d& world) {
  return {world(1), world(2), world(0)};
}
inline Axis FromYUp(Axis file) { return static_cast<Axis>((static_cast<int>(file) + 1) % 3); }
inline Axis ToYUp(Axis world) { return static_cast<Axis>((static_cast<int>(world) + 2) % 3); }

/// Rz Ry Rx of three angles about the file's axes (ASF "axis a b c XYZ"), in W.
inline Eigen::Matrix3d FromYUpXyz(const Eigen::Vector3d& angles_rad) {
  return AxisRotation(FromYUp(Axis::kZ), angles_rad(2)) *
         AxisRotation(FromYUp(Axis::kY), angles_rad(1)) *
         AxisRotation(FromYUp(Axis::kX), angles_rad(0));
}

}  // namespace footing::body
