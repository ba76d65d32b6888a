#pragma once

#include <array>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "common/base/result.h"
#include "common/body/landmarks.h"
#include "common/virtual/motion/motion.h"

/// Skeletons whose frames have no known meaning, understood from the movement itself.
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

/// A motion of the standard person's layout (body::StandardPerson), which is what the engine runs.
struct StandardMotion {
  Motion motion;
  double height_m = 0;  ///< Estimated from the lengths.
  double rms_m = 0;     ///< Distance of the markers below, RMS.
};

/// True when the motion's degrees of freedom are the standard person's, by number and name.
bool HasStandardLayout(const Motion& motion);
bool IsStandardLayout(const std::vector<std::string>& dofs);

/// Another skeleton's motion as the standard person's: markers are put about its joints and fitted
/// (FitMarkers), so that lengths and joint centres stay. An error says which landmark is
/// missing.
Result<StandardMotion> ToStandardLayout(const Motion& motion);

}  // namespace footing::motion
