#pragma once

#include <Eigen/Core>

#include "common/virtual/motion/motion.h"

/// The joints of a BVH file between its root and the joint on which the legs hang.
namespace footing::motion {

/// Number of joints below the root down to the first one with several children: joints 1 to n, each
/// on the one before. Several programs put a joint on the floor there and move the hips on it.
int StemLength(const body::Skeleton& skeleton);

/// The motion with the lowest joint of the stem that moves on its parent as its root; itself when
/// none does. `stem_m` has three rows for each joint of the stem, its place on its parent in W's
/// axes, and a column for each frame.
Motion OnMovingJoint(Motion motion, const Eigen::MatrixXd& stem_m, double still_m);

}  // namespace footing::motion
