#pragma once

#include <Eigen/Core>

namespace footing::sphere::disc {

/// What the residuals of a sphere at rest say of motion, and what motion does to its fit.
struct MotionEvidence {
  /// Blur with twice the angle, px: its cosine and sine; travel that the rolling shutter shows, px.
  Eigen::Vector4d change;
  Eigen::Matrix4d information;             ///< Inverse of the noise of these.
  double blur_px = 0;                      ///< Of the sphere at rest.
  Eigen::Vector3d per_blur;                ///< Axis and tangent by an even blur,
  Eigen::Matrix<double, 3, 2> per_travel;  ///< and by travel.
};

/// Mean square error of axis and tangent that a motion leaves which is not modelled: over all
/// motions that the evidence allows. Travel is normal along each axis, with `motion_sd_px`; some
/// hands are at rest.
Eigen::Matrix3d UnseenMotion(const MotionEvidence& evidence, double motion_sd_px);

}  // namespace footing::sphere::disc
