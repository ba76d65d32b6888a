#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "common/camera/observations.h"
#include "common/base/result.h"

/// Where a camera stands in the boards' world frame W.
namespace footing::camera_pose {

using Covariance = Eigen::Matrix<double, 6, 6>;

/// An estimated pose, and how well what was seen fits it.
struct CameraPose {
  Eigen::Isometry3d X_WC = Eigen::Isometry3d::Identity();
  /// Of the turn about W's axes, rad, and of W's origin, m: a point p is off by turn x p + shift.
  Covariance covariance = Covariance::Zero();
  std::vector<double> residuals_m;  ///< Of each mark.
  double residual_rms_m = 0;
  double scale = 1;  ///< True lengths over those that the camera sees.
  double scale_sd = 0;
  double misfit = 0;    ///< Squared residuals over what noise and placement explain; about 1.
  double tilt_rad = 0;  ///< Between gravity by the plumbs and the vertical of the marks.

  /// Covariance of a point of W, as what the pose adds to a measurement.
  Eigen::Matrix3d CovarianceAt(const Eigen::Vector3d& p_W_m) const;
  /// Standard deviation of the turn, of its worst axis.
  double TurnSdRad() const;
};

/// The weighted least squares fit of all marks and plumbs; no check but that there are three marks
/// or more. Depth is what a camera knows worst, so each mark counts by its whole covariance.
CameraPose Fit(const Observations& observations);

/// `Fit`, and refusals, each with what, why and what to do: fewer than three marks, marks in a line
/// (within 0.1 m), a mirrored image, lengths that are off by more than 2 %, a mark in the wrong
/// place, gravity that is off by more than 4 degrees, and a turn that stays uncertain by more than
/// 1 degree.
Result<CameraPose> Calibrate(const Observations& observations);

}  // namespace footing::camera_pose
