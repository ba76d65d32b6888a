#include "daemon/simulation/pose/arm_geometry.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace footing::arms {
namespace {

using body::Landmark;

Eigen::Vector3d Unit(const Eigen::Vector3d& v) {
  const double norm = v.norm();
  return norm > 1e-9 ? Eigen::Vector3d(v / norm) : Eigen::Vector3d::UnitZ();
}

double Angle(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::acos(std::clamp(Unit(a).dot(Unit(b)), -1.0, 1.0));
}

Eigen::Matrix3d Frame(const ArmDirections& arm) {
  Eigen::Matrix3d frame;
  frame.col(0) = Unit(arm.upper);
  frame.col(1) = Unit(arm.hinge - arm.hinge.dot(frame.col(0)) * frame.col(0));
  frame.col(2) = frame.col(0).cross(frame.col(1));
  return frame;
}

}  // namespace

ArmGeometry::ArmGeometry(const body::Body& body, int side) : fist(body::Fist(body, side)) {
  const auto landmark = [&](Landmark left) {
    return body.landmarks[side == 0 ? left : body::Mirrored(left)];
  };
  shoulder = landmark(Landmark::kLeftShoulder);
  elbow = landmark(Landmark::kLeftElbow);
  body::Kinematics at(body.skeleton);
  body::ComputeKinematics(body.skeleton, body::TPose(body.skeleton, body.landmarks), at);
  const auto place = [&](int joint) { return at.p_WJ[static_cast<std::size_t>(joint)]; };
  hinge_J = at.R_WJ[static_cast<std::size_t>(shoulder)].transpose() * Eigen::Vector3d::UnitZ();
  upper_m = (place(elbow) - place(shoulder)).norm();
  forearm_m = (body::Place(fist, at) - place(elbow)).norm();
}

ArmDirections ArmGeometry::Directions(const body::Kinematics& at) const {
  const auto s = static_cast<std::size_t>(shoulder), e = static_cast<std::size_t>(elbow);
  return {Unit(at.p_WJ[e] - at.p_WJ[s]), at.R_WJ[s] * hinge_J,
          Unit(body::Place(fist, at) - at.p_WJ[e])};
}

double ShoulderError(const ArmDirections& a, const ArmDirections& b) {
  const double cosine = ((Frame(a).transpose() * Frame(b)).trace() - 1) / 2;
  return std::acos(std::clamp(cosine, -1.0, 1.0));
}

double ElbowError(const ArmDirections& a, const ArmDirections& b) {
  return std::abs(Angle(a.upper, a.forearm) - Angle(b.upper, b.forearm));
}

}  // namespace footing::arms
