#pragma once

#include <string>
#include <vector>

#include "common/camera/dot_grid.h"
#include "common/base/result.h"
#include "common/camera/lens.h"

namespace footing::lens_calibration {

using View = std::vector<GridDot>;

/// A fitted lens and how well it is known.
struct LensFit {
  sphere::Lens lens;
  double rms_px = 0;       ///< Of a dot's two coordinates together.
  double largest_px = 0;   ///< The worst dot.
  double focal_sd_px = 0;  ///< Standard deviation of fx and fy, the larger one.
  double centre_sd_px = 0;
  double covered = 0;  ///< Share of the image, in 8 x 6 parts, that has a dot in some view.
};

/// Share of the image, in 8 x 6 parts, in which some view has a dot.
double Covered(const std::vector<View>& views, int width, int height);

/// Focal lengths, principal point, k1, k2, p1 and p2 from views of one flat sheet, whose pitch does
/// not matter (Zhang, A flexible new technique for camera calibration, 2000, with square pixels at
/// the start). InvalidData says what is wrong with the views: fewer than six, all of them parallel
/// to the sensor, a residual above 0.5 px, or parts of the image without dots.
Result<LensFit> FitLens(const std::vector<View>& views, int width, int height);

}  // namespace footing::lens_calibration
