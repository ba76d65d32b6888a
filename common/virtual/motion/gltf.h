#pragma once

#include <string>

#include "common/base/result.h"
#include "common/virtual/motion/motion.h"

namespace footing::motion {

/// A motion as a binary glTF 2.0 file (.glb; Khronos Group): the joints as nodes that stand at rest
/// as the skeleton does, a box for each bone, and one animation that turns the joints and moves the
/// root. Metres, y up, z ahead. InvalidData where it would not fit into a file's 4 GiB.
Result<std::string> WriteGlb(const Motion& motion, const std::string& name);

}  // namespace footing::motion
