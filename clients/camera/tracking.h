#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "clients/camera/video_port.h"
#include "common/frames/camera_file.h"
#include "common/net/address.h"
#include "common/stream/hands.h"

namespace footing::camera {

/// Options of a tracking run.
struct TrackingOptions {
  frames::CameraFile camera;
  std::string camera_path;  ///< A new calibration is taken from there while tracking; may be empty.
  FrameOptions frames;
  bool simulated = false;  ///< The frames are not of a camera.
  bool challenge = true;   ///< Switch a sphere's light when it is in doubt (light_checks.h).
  double seconds = 0;      ///< 0: until the frames end, or a signal.
  transport::Address to;
  transport::Address
      sensor;  ///< footingd's client socket, where the file's lights are switched on.
  std::optional<transport::Address> preview;  ///< A Unix socket; nothing: no preview.
  bool needs_preview = false;  ///< A preview that cannot be shown is an error, not a warning.
};

/// Report of a run.
struct TrackingReport {
  std::uint64_t frames = 0, sent = 0;
  std::vector<std::uint64_t> found;  ///< Finds of each sphere.
  int challenges_passed = 0;         ///< Spheres whose light followed when it was switched.
  int lights_refused = 0;            ///< Lights that did not.
  std::uint64_t saturated = 0;       ///< Spheres at the sensor's limit.
  std::vector<std::string> alarms;   ///< Faults of the camera, first lines.
  double cost_p50_ms = 0, cost_p99_ms = 0;
  Result<void> sent_on;  ///< No device: footingd was not there for all of `seconds`, or until the
                         ///< frames ended.
};

/// Reads frames, finds the spheres and sends them to footingd until the end.
Result<TrackingReport> Track(const TrackingOptions& options);

/// Frames of one image for footingd: one for every sphere of the camera file, since each row of a
/// rolling shutter has a time of its own. Its point is in W with the covariance of the estimate;
/// for a sphere that was not found it has confidence 0. `age_ns` is from the mid-exposure of the
/// row on which the sphere appears to `now_ns`; `exposed_ns` is that of the middle row, which
/// counts for a sphere that was not found. Without X_WC points are in the camera's own frame, and
/// tracker_pose is the identity. A sphere of the head is the joint of that name.
std::vector<stream::HandFrame> ToHandFrames(
    const frames::CameraFile& camera, const std::optional<Eigen::Isometry3d>& calibrated_X_WC,
    const std::vector<std::optional<sphere::Estimate>>& found, std::int64_t exposed_ns,
    std::int64_t now_ns);

}  // namespace footing::camera
