#pragma once

#include <Eigen/Core>

namespace footing::body {

/// A vector in a Wiimote's own frame (x left, y front, z down) in the held frame of a fist, and
/// back: x where the device points, y left, z up while its buttons face up. With the arms of a
/// T-pose the axes of the held frame are W's.
inline Eigen::Vector3d AsHeld(const Eigen::Vector3d& v) { return {v.y(), v.x(), -v.z()}; }

}  // namespace footing::body
