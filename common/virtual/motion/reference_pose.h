#pragma once

#include <Eigen/Core>
#include <array>

#include "common/body/landmarks.h"
#include "common/virtual/motion/motion.h"

/// What the movement itself says of a skeleton whose frames mean nothing to us.
namespace footing::motion {

/// A pose in which the person stands upright and looks along x: the T-pose about the skeleton's own
/// rest (body::TPose) where that is a person, else the most upright frame of the motion, turned
/// about the vertical. At rest some programs' skeletons lie along one axis in one line.
Eigen::VectorXd ReferencePose(const Motion& motion, const body::Landmarks& landmarks);

/// Direction in W, with the joints as in `pose`, in which a knee's or an elbow's lateral side lies.
struct HingeAxes {
  std::array<Eigen::Vector3d, 2> knee_W, elbow_W;  ///< Left, right; unit length.
};

/// From the planes in which the limbs bend in the motion, which hold whatever the twist of the
/// rest pose; of a limb that never bends (by 15 degrees in the mean of the frames that count) the
/// direction of the T-pose: outwards of a knee, backwards of an elbow.
HingeAxes FindHingeAxes(const Motion& motion, const body::Landmarks& landmarks,
                        const Eigen::VectorXd& pose);

}  // namespace footing::motion
