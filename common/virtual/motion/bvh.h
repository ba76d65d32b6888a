#pragma once

#include <string>
#include <string_view>

#include "common/base/result.h"
#include "common/virtual/motion/motion.h"

/// Biovision hierarchy (BVH): skeleton and motion in one text file; y up, z ahead, degrees.
namespace footing::motion {

struct BvhOptions {
  double unit_m = 0.01;  ///< Of lengths and positions. Centimetres are usual, never stated.
};

/// Reads a BVH file into W. Channels may stand in any order; the order of a joint's rotations is
/// kept. Only the root moves, or a joint between it and the first one with several children, which
/// then becomes the root (bvh_stem.h): position channels of another joint must stay where they
/// begin. End sites become joints "NAME_end". `file` is its name for errors, which say the line and
/// what was expected there.
Result<Motion> ParseBvh(std::string_view text, const std::string& file,
                        const BvhOptions& options = {});

/// Writes one, in centimetres. Joints without own axes and with three rotations are written as they
/// are, so what was read from our own output is written again byte for byte; any other joint that
/// turns is written as three rotations.
std::string WriteBvh(const Motion& motion);

}  // namespace footing::motion
