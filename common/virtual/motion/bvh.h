#pragma once

#include <string>
#include <string_view>

#include <Eigen/Core>

#include "common/base/result.h"
#include "common/virtual/motion/motion.h"

/// Biovision hierarchy (BVH): skeleton and motion in one text file; y up, z ahead, degrees.
namespace footing::motion {

/// Facts that a BVH file does not state.
struct BvhOptions {
  double unit_m = 0.01;  ///< Unit of lengths and positions. Centimetres are usual, never stated.
};

/// Reads a BVH file into W. Channels may stand in any order; the order of a joint's rotations is
/// kept. Only the root moves, or a joint between it and the first one with several children, which
/// then becomes the root: position channels of another joint must stay where they
/// begin. End sites become joints "NAME_end". `file` is its name for errors, which say the line and
/// what was expected there.
Result<Motion> ParseBvh(std::string_view text, const std::string& file,
                        const BvhOptions& options = {});

/// Writes one, in centimetres. Joints without own axes and with three rotations are written as they
/// are, so what was read from our own output is written again byte for byte; any other joint that
/// turns is written as three rotations.
std::string WriteBvh(const Motion& motion);

// The joints of a BVH file between its root and the joint on which the legs hang.

/// Number of joints below the root down to the first one with several children: joints 1 to n, each
/// on the one before. Several programs put a joint on the floor there and move the hips on it.
int StemLength(const body::Skeleton& skeleton);

/// The motion with the lowest joint of the stem that moves on its parent as its root; itself when
/// none does. `stem_m` has three rows for each joint of the stem, its place on its parent in W's
/// axes, and a column for each frame.
Motion OnMovingJoint(Motion motion, const Eigen::MatrixXd& stem_m, double still_m);

}  // namespace footing::motion
