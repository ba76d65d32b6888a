#pragma once

#include <Eigen/Core>

namespace footing::eval {

/// A hip as gait analysis reports it, degrees; 0 in the T-pose, in which the thighs hang straight
/// down. Flexion is positive forwards, abduction outwards, rotation inwards.
struct HipAngles {
  double flexion = 0;    ///< Of the thigh in the sagittal plane of the pelvis.
  double abduction = 0;  ///< Of the thigh out of that plane.
  /// Of the thigh about itself, beyond the least turn that brings it down to where it points. The
  /// cardan angles of Grood & Suntay (1983) differ from this when the hip is both bent and spread,
  /// and have no rotation where the thigh points sideways.
  double rotation = 0;
};

/// `R_PT`: how the thigh has turned in the pelvis since the T-pose, in axes of the pelvis that are
/// W's in the T-pose (x forward, y left, z up). Side 0 is left.
HipAngles HipAnglesDeg(const Eigen::Matrix3d& R_PT, int side);

/// Magnitudes of the differences, each 180 degrees at most.
HipAngles Difference(const HipAngles& a, const HipAngles& b);

}  // namespace footing::eval
