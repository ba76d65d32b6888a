#pragma once

#include "common/body/body.h"
#include "common/virtual/motion/motion.h"

namespace footing::pose_run {

/// Stands in a T-pose all the time.
inline motion::Motion Standing(double seconds) {
  motion::Motion motion;
  motion.skeleton = body::StandardPerson(1.75);
  const body::Landmarks landmarks = body::FindLandmarks(motion.skeleton).value();
  motion.rate_hz = 60;
  motion.q = body::TPose(motion.skeleton, landmarks)
                 .replicate(1, static_cast<Eigen::Index>(seconds * motion.rate_hz));
  return motion;
}

}  // namespace footing::pose_run
