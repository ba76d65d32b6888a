#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <vector>

#include "common/frames/camera_file.h"
#include "common/stream/hands.h"

namespace footing::camera {

/// What footingd is sent of one frame: every sphere of the camera file as a point of W with the
/// covariance of its estimate, and one with confidence 0 for each that was not found. The frame's
/// `age_ns` is from the mid-exposure of the row on which the first found sphere appears to
/// `now_ns`; `exposed_ns` is that of the middle row. Without X_WC points are in the camera's own
/// frame, and the frame's tracker_pose is the identity.
stream::HandFrame ToHandFrame(const frames::CameraFile& camera,
                              const std::optional<Eigen::Isometry3d>& calibrated_X_WC,
                              const std::vector<std::optional<sphere::Estimate>>& found,
                              std::int64_t exposed_ns, std::int64_t now_ns);

}  // namespace footing::camera
