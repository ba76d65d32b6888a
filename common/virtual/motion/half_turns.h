#pragma once

#include "common/virtual/motion/motion.h"

namespace footing::motion {

/// The same movement of a skeleton with legs (body::FindLandmarks) whose knee is a hinge, without
/// thighs that turn by half a turn about themselves from one frame to the next. Beyond full flexion
/// a fit to markers can take the other solution: the thigh turned by half a turn and the knee bent
/// the other way. Hip, knee and ankle are at the same places; the foot is turned to where it was as
/// nearly as its angles allow. Each frame takes the solution whose hip is nearer to the frame
/// before. Other skeletons are returned as they are.
Motion WithoutHalfTurns(Motion motion);

}  // namespace footing::motion
