#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <vector>

#include "common/frames/camera_file.h"
#include "common/stream/hands.h"

namespace footing::camera {

/// What footingd is sent of one image: a frame for every sphere of the camera file, since each row
/// of a rolling shutter has a time of its own. Its point is in W with the covariance of the
/// estimate; of a sphere that was not found it has confidence 0. `age_ns` is from the mid-exposure
/// of the row on which the sphere appears to `now_ns`; `exposed_ns` is that of the middle row,
/// which counts for a sphere that was not found. Without X_WC points are in the camera's own frame,
/// and tracker_pose is the identity. A sphere of the head is the joint of that name.
std::vector<stream::HandFrame> ToHandFrames(
    const frames::CameraFile& camera, const std::optional<Eigen::Isometry3d>& calibrated_X_WC,
    const std::vector<std::optional<sphere::Estimate>>& found, std::int64_t exposed_ns,
    std::int64_t now_ns);

}  // namespace footing::camera
