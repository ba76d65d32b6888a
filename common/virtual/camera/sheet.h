#pragma once

#include <Eigen/Geometry>

#include "common/virtual/camera/scene.h"
#include "common/virtual/devices/random.h"

namespace footing::virtual_camera {

/// A white sheet with black dots in columns and rows, as footing-camera lens prints it. Its frame:
/// x along the rows, y down the columns, the origin in the middle of the dots.
struct DotSheet {
  int columns = 13, rows = 9;
  double pitch_m = 0.02, radius_m = 0.005, margin_m = 0.02;
  Eigen::Isometry3d X_CS = Eigen::Isometry3d::Identity();
  Eigen::Vector3d paper_dn{180, 190, 170}, ink_dn{20, 22, 21};
};

/// The frame that the sensor reads of a sheet before the scene's background, each pixel 16-fold.
Mosaic RenderSheet(const Scene& scene, const DotSheet& sheet, noise::Random& random);

}  // namespace footing::virtual_camera
