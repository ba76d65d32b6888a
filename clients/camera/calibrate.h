#pragma once

#include <string>

#include "clients/camera/blink_calibration.h"
#include "clients/camera/source.h"
#include "common/stream/device.h"
#include "common/net/address.h"

namespace footing::camera {

struct CalibrateOptions {
  frames::CameraFile camera;  ///< Its spheres are replaced; their radii stay.
  FrameOptions frames;
  transport::Address sensor;  ///< footingd's client socket, where lights are switched.
};

/// What a calibration found: one for each PS Move with a role.
struct BlinkReport {
  struct Sphere {
    stream::DeviceRole role = stream::DeviceRole::kUnspecified;
    std::string serial;
    double radius_m = 0;
    CalibratedSphere calibrated;
  };
  std::vector<Sphere> spheres;
  sphere::Profile profile;
};

/// Switches the lights of the PS Moves through footingd, and finds out from the frames what each
/// looks like. Afterwards they are lit as they are to be tracked. NoDevice without footingd or a
/// PS Move.
Result<BlinkReport> Calibrate(const CalibrateOptions& options);

}  // namespace footing::camera
