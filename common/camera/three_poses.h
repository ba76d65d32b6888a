#pragma once

#include "common/camera/camera_pose.h"

namespace footing::camera_pose {

/// The paper's calibration (Ha, Bai & Liu 2011, section 5.1, Figure 3): the sphere at the origin of
/// the axes, then ahead of it, then to its left.
struct ThreePoses {
  SeenPoint origin, ahead, left;
  Eigen::Vector3d p_WO_m{0, 0, 0};  ///< Where in W the sphere was in the first pose.
  /// Distances of the other two from the first, where they are known; 0: not known.
  double ahead_m = 0, left_m = 0;
  double placement_sd_m = 0.025;  ///< Of a hand that holds a pose in the air, per axis.
};

/// x points from the first place to the second, and the third is on y's side. Refuses places nearer
/// than 0.2 m, an angle between them outside of 60 to 120 degrees, known distances that are off by
/// more than 2 % and three standard deviations of placement and of what was seen, and a mirrored
/// image.
Result<CameraPose> FromThreePoses(const ThreePoses& poses);

}  // namespace footing::camera_pose
