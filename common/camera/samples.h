#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "common/camera/observations.h"
#include "common/stream/hands.h"

namespace footing::camera_pose {

/// What a tracker saw in its own frame, of what footingd published of it in W. Nothing where the
/// point was not seen, or the tracker has no frame of its own.
std::optional<SeenPoint> InTrackerFrame(const stream::HandSample& sample);

/// The same sight by another calibration. A sample of a tracker without a frame stays as it is.
stream::HandSample Recalibrated(const stream::HandSample& sample, const Eigen::Isometry3d& X_WC);

}  // namespace footing::camera_pose
