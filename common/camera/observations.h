#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "common/base/result.h"

namespace footing::camera_pose {

/// Where a sphere's centre was seen, in the camera's frame C.
struct SeenPoint {
  Eigen::Vector3d p_C_m{0, 0, 0};
  Eigen::Matrix3d covariance_m2 = Eigen::Matrix3d::Zero();
};

/// A sphere on a point whose place in W is known.
struct SeenMark {
  std::string name;
  Eigen::Vector3d p_W_m{0, 0, 0};  ///< Of the sphere's centre.
  SeenPoint seen;
};

/// A controller's sphere on a mark, then above the same mark with the controller standing upright.
/// Its accelerometer measures how upright: the line between the two places is gravity's.
struct SeenPlumb {
  SeenPoint low, high;
  double tilt_rad = 0;  ///< Between the controller's long axis and the vertical.
};

struct Observations {
  std::vector<SeenMark> marks;
  std::vector<SeenPlumb> plumbs;
  double placement_sd_m = 0.001;  ///< Of the sphere on a mark, per axis.
};

/// Frames of a sphere at rest that are enough for a mean: half a second of a camera at 60 Hz.
inline constexpr std::size_t kLeastFrames = 30;

/// The mean of a sphere at rest. What of the frames' covariance does not show as scatter is common
/// to all frames (blur and limb of the camera file, the same pixels) and is not averaged away.
/// Refuses fewer than kLeastFrames, and a sphere that moved.
Result<SeenPoint> MeanAtRest(const std::vector<SeenPoint>& frames);

}  // namespace footing::camera_pose
