#pragma once

#include <Eigen/Core>

#include "common/body/body.h"
#include "common/body/kinematics.h"

/// Points of the body that sensors measure.
namespace footing::body {

/// A point fixed to a joint's frame.
struct Point {
  int joint = 0;
  Eigen::Vector3d p_J_m = Eigen::Vector3d::Zero();
};

/// Middle of the fist, of side 0 (left) or 1: 0.6 of the way from the wrist to where the hand ends
/// (its landmark, or the end point that hangs on the wrist); the wrist itself where there is
/// neither.
Point Fist(const Body& body, int side);

/// Joint of the ankle.
Point Ankle(const Body& body, int side);

/// Ball of the foot; the tip of the toes where the skeleton has no ball, the ankle where it has
/// neither.
Point Toe(const Body& body, int side);

/// Tip of the toes, else as Toe.
Point ToeEnd(const Body& body, int side);

/// Where it is: `R_WJ` and `p_WJ` of its joint.
inline Eigen::Vector3d Place(const Point& point, const Eigen::Matrix3d& R_WJ,
                             const Eigen::Vector3d& p_WJ) {
  return p_WJ + R_WJ * point.p_J_m;
}
/// The same where the joints are `at`.
inline Eigen::Vector3d Place(const Point& point, const Kinematics& at) {
  const auto joint = static_cast<std::size_t>(point.joint);
  return Place(point, at.R_WJ[joint], at.p_WJ[joint]);
}

}  // namespace footing::body
