#pragma once

#include <Eigen/Core>

#include "common/body/body.h"
#include "common/body/kinematics.h"
#include "common/body/points.h"

namespace footing::arms {

/// How an arm is held, by unit vectors in W: three angles of the shoulder (`upper`, and `hinge`
/// about it) and one of the elbow (between `upper` and `forearm`).
struct ArmDirections {
  Eigen::Vector3d upper = Eigen::Vector3d::UnitY();    ///< Shoulder to elbow.
  Eigen::Vector3d hinge = Eigen::Vector3d::UnitZ();    ///< Of the upper arm: up in the T-pose.
  Eigen::Vector3d forearm = Eigen::Vector3d::UnitY();  ///< Elbow to the middle of the fist.
};

/// One arm of a body, of side 0 (left) or 1.
struct ArmGeometry {
  int shoulder = 0, elbow = 0;
  body::Point fist;
  Eigen::Vector3d hinge_J = Eigen::Vector3d::UnitZ();  ///< In the shoulder's frame.
  double upper_m = 0, forearm_m = 0;                   ///< Of the T-pose.

  ArmGeometry(const body::Body& body, int side);

  ArmDirections Directions(const body::Kinematics& at) const;
  /// From the shoulder to the fist, W.
  Eigen::Vector3d Hand(const ArmDirections& arm) const {
    return upper_m * arm.upper + forearm_m * arm.forearm;
  }
};

/// Angle by which one upper arm is turned against the other, and the difference of the elbows'
/// angles, rad.
double ShoulderError(const ArmDirections& a, const ArmDirections& b);
double ElbowError(const ArmDirections& a, const ArmDirections& b);

}  // namespace footing::arms
