#pragma once

#include <optional>
#include <string>
#include <vector>

#include "clients/camera/source.h"
#include "common/net/address.h"

namespace footing::camera {

struct TrackingOptions {
  frames::CameraFile camera;
  std::string camera_path;  ///< A new calibration is taken from there while tracking; may be empty.
  FrameOptions frames;
  bool simulated = false;  ///< The frames are not of a camera.
  bool challenge = true;   ///< Switch a sphere's light when it is in doubt (challenge.h).
  double seconds = 0;      ///< 0: until the frames end, or a signal.
  transport::Address to;
  transport::Address
      sensor;  ///< footingd's client socket, where the file's lights are switched on.
  std::optional<transport::Address> preview;  ///< A Unix socket; nothing: no preview.
  bool needs_preview = false;  ///< A preview that cannot be shown is an error, not a warning.
};

/// What a run did.
struct TrackingReport {
  std::uint64_t frames = 0, sent = 0;
  std::vector<std::uint64_t> found;  ///< Of each sphere.
  int challenges_passed = 0;         ///< Spheres whose light followed when it was switched.
  int lights_refused = 0;            ///< Lights that did not.
  std::uint64_t saturated = 0;       ///< Spheres at the sensor's limit.
  std::vector<std::string> alarms;   ///< What was wrong with the camera, first lines.
  double cost_p50_ms = 0, cost_p99_ms = 0;
  Result<void> sent_on;  ///< No device: footingd was not there for all of `seconds`, or until the
                         ///< frames ended.
};

/// Reads frames, finds the spheres and sends them to footingd until the end.
Result<TrackingReport> Track(const TrackingOptions& options);

}  // namespace footing::camera
