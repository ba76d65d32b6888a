#pragma once

#include <Eigen/Core>

#include "common/camera/lens.h"

namespace footing::sphere {

/// Slopes around a direction, as a function of the pixel: exact at nine pixels of a window, and
/// quadratic between them (below 0.002 px for a lens that bends 10 % at its corners).
class LocalSlopes {
 public:
  /// `middle` is the window's middle and the direction of the third axis, `half_px` its half size.
  LocalSlopes(const Lens& lens, const Eigen::Vector2d& middle, double half_px);

  Eigen::Vector2d At(double u, double v) const;
  /// d slopes / d pixel in the middle.
  const Eigen::Matrix2d& scale() const { return scale_; }
  /// How that changes, per pixel along u (0) or v (1).
  Eigen::Matrix2d ScaleChange(int axis) const;
  /// Columns: the axes of s and t and the third one, in C.
  const Eigen::Matrix3d& R_CL() const { return R_CL_; }

 private:
  Eigen::Vector2d middle_;
  double half_px_;
  Eigen::Matrix<double, 2, 9> terms_;  ///< Of 1, x, x², y, xy, x²y, y², xy², x²y².
  Eigen::Matrix2d scale_;
  Eigen::Matrix3d R_CL_;
};

}  // namespace footing::sphere
