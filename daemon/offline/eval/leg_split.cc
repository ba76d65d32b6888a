#include "daemon/offline/eval/leg_split.h"

#include <Eigen/Geometry>
#include <cmath>

namespace footing::eval {
namespace {

constexpr double kLeastM = 1e-6;

struct Circle {
  Eigen::Vector3d axis;      ///< From hip to ankle, of length 1.
  Eigen::Vector3d centre_m;  ///< Where the knee's plane cuts the line.
  Eigen::Vector3d radius_m;  ///< From there to the knee.
};

Circle CircleOf(const LegPlaces& leg) {
  const Eigen::Vector3d axis = (leg.ankle - leg.hip).normalized();
  const Eigen::Vector3d centre_m = leg.hip + axis.dot(leg.knee - leg.hip) * axis;
  return {axis, centre_m, leg.knee - centre_m};
}

}  // namespace

KneeError SplitKneeError(const LegPlaces& truth, const LegPlaces& estimate) {
  const Circle was = CircleOf(truth), is = CircleOf(estimate);
  KneeError error{.turn_rad = 0, .unturned_m = (estimate.knee - truth.knee).norm()};
  if (was.radius_m.norm() < kLeastM || is.radius_m.norm() < kLeastM) return error;
  const Eigen::Vector3d expected =
      Eigen::Quaterniond::FromTwoVectors(was.axis, is.axis) * was.radius_m.normalized();
  error.turn_rad = std::atan2(is.axis.dot(expected.cross(is.radius_m)), expected.dot(is.radius_m));
  const Eigen::Vector3d turned_back_m = is.centre_m + is.radius_m.norm() * expected;
  error.unturned_m = (turned_back_m - truth.knee).norm();
  return error;
}

}  // namespace footing::eval
