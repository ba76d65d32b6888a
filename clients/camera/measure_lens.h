#pragma once

#include "clients/camera/source.h"
#include "common/camera/fit_lens.h"

namespace footing::camera {

struct LensOptions {
  frames::CameraFile camera;  ///< Its size and format are those of the frames.
  FrameOptions frames;
  int views = 12;
  double seconds = 300;  ///< After that the views so far are used.
};

struct LensReport {
  lens_calibration::LensFit fit;
  std::size_t frames = 0, views = 0;
};

/// Guides a person, by lines of the log, who moves a sheet of dots before the camera, and fits the
/// lens to what was seen.
Result<LensReport> MeasureLens(const LensOptions& options);

}  // namespace footing::camera
