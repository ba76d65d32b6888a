#pragma once

#include "common/body/landmarks.h"
#include "common/virtual/motion/motion.h"

namespace footing::learning {

/// The motion turned and moved as a whole: facing x (the mean of right to left hip is y), the
/// median middle of the feet over the origin, and the floor at z = 0 (the lowest of the toes lies
/// 1.5 cm above it in all but 2 % of the frames, which lie lower). Angles are unwrapped: none jumps
/// by more than half a turn from one frame to the next.
motion::Motion Aligned(const motion::Motion& motion, const body::Landmarks& landmarks);

/// text::Quantile of a vector, which must not be empty.
double Quantile(const Eigen::VectorXd& values, double share);

}  // namespace footing::learning
