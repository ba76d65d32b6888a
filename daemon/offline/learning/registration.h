#pragma once

#include <Eigen/Core>

#include "common/virtual/motion/motion.h"

namespace footing::learning {

/// How the floor of one recording lies in that of another: turned about the vertical, then moved.
struct FloorPlacement {
  double yaw_rad = 0;
  Eigen::Vector2d shift_m = Eigen::Vector2d::Zero();
  double rms_m = 0;         ///< What is left, of the points that count.
  Eigen::Index points = 0;  ///< That count.
};

/// Least squares of `from` on `to`, a column a pair, without the pairs that are left far off: feet
/// beyond a board's edge. There must be three pairs.
FloorPlacement PlaceFloor(const Eigen::Matrix2Xd& from, const Eigen::Matrix2Xd& to);

/// The motion turned and moved as a whole.
motion::Motion Placed(const motion::Motion& motion, const FloorPlacement& placement);

}  // namespace footing::learning
