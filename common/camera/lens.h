#pragma once

#include <Eigen/Core>
#include <string>

namespace footing::sphere {

/// A calibrated lens: focal lengths and principal point, px, and Brown's distortion as OpenCV
/// orders it. Camera frame C: x right, y down, z forward.
struct Lens {
  int width = 640, height = 480;
  double fx_px = 540, fy_px = 540, cx_px = 319.5, cy_px = 239.5;
  double k1 = 0, k2 = 0, p1 = 0, p2 = 0, k3 = 0;
};

/// Problem of a lens, in one line; empty when it can be used: sizes even and from 32 to 4096, focal
/// lengths from 0.2 to 20 widths, the principal point in the image, and a distortion that can be
/// undone everywhere in the image.
std::string Problem(const Lens& lens);

/// x/z and y/z in C of what is seen at a pixel.
Eigen::Vector2d Undistort(const Lens& lens, const Eigen::Vector2d& pixel);

/// The pixel at which x/z and y/z appear.
Eigen::Vector2d ToPixel(const Lens& lens, const Eigen::Vector2d& slopes);

}  // namespace footing::sphere
