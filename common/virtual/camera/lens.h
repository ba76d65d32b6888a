#pragma once

#include <Eigen/Core>

namespace footing::virtual_camera {

/// The simulated camera's lens, pinhole with radial and tangential distortion (Brown's model, the
/// order of OpenCV). Camera frame C: x right, y down, z forward; pixels: the middle of the first
/// one is (0, 0). The estimator has a lens of its own (common/sphere), on purpose.
struct Lens {
  int width = 640, height = 480;
  double fx_px = 540, fy_px = 540, cx_px = 319.5, cy_px = 239.5;
  double k1 = 0, k2 = 0, p1 = 0, p2 = 0, k3 = 0;
};

/// Where a point of C in front of the camera appears, px.
Eigen::Vector2d Project(const Lens& lens, const Eigen::Vector3d& p_C_m);

/// The unit vector in C that is seen at a pixel; Newton's method on the distortion.
Eigen::Vector3d RayThrough(const Lens& lens, const Eigen::Vector2d& pixel);

}  // namespace footing::virtual_camera
