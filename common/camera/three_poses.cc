#include "common/camera/three_poses.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "common/base/number.h"
#include "common/base/units.h"

namespace footing::camera_pose {
namespace {

using Eigen::Vector3d;
using Places = std::array<Vector3d, 3>;  // Origin, ahead, left, in C.

constexpr double kLeastSpanM = 0.2;
constexpr double kMostLengthOff = 0.02;

Eigen::Isometry3d PoseOf(const Places& places, const Vector3d& p_WO_m) {
  const Vector3d x = (places[1] - places[0]).normalized();
  const Vector3d z = x.cross(places[2] - places[0]).normalized();
  Eigen::Isometry3d X_CW = Eigen::Isometry3d::Identity();
  X_CW.linear() << x, z.cross(x), z;
  X_CW.translation() = places[0] - X_CW.linear() * p_WO_m;
  return X_CW.inverse();
}

/// What noise of the places does to turn and shift, by differences.
Covariance CovarianceOf(const Places& places, const ThreePoses& poses) {
  constexpr double kStepM = 1e-6;
  const Eigen::Isometry3d X_WC = PoseOf(places, poses.p_WO_m);
  const std::array<const SeenPoint*, 3> seen = {&poses.origin, &poses.ahead, &poses.left};
  Covariance covariance = Covariance::Zero();
  for (std::size_t k = 0; k < places.size(); ++k) {
    Eigen::Matrix<double, 6, 3> rows;
    for (int axis = 0; axis < 3; ++axis) {
      Places moved = places;
      moved[k][axis] += kStepM;
      const Eigen::Isometry3d change = PoseOf(moved, poses.p_WO_m) * X_WC.inverse();
      const Eigen::AngleAxisd turn(change.rotation());
      rows.col(axis) << turn.angle() / kStepM * turn.axis(), change.translation() / kStepM;
    }
    const Eigen::Matrix3d noise = seen[k]->covariance_m2 + poses.placement_sd_m *
                                                               poses.placement_sd_m *
                                                               Eigen::Matrix3d::Identity();
    covariance += rows * noise * rows.transpose();
  }
  return covariance;
}

/// Variance of the distance between two places: of each, along the line between them.
double SpanVarianceM2(const SeenPoint& from, const SeenPoint& to, double placement_sd_m) {
  const Vector3d along = (to.p_C_m - from.p_C_m).normalized();
  return along.dot((from.covariance_m2 + to.covariance_m2) * along) +
         2 * placement_sd_m * placement_sd_m;
}

std::optional<Error> WrongSpan(const char* name, double seen_m, double known_m,
                               double variance_m2) {
  const std::string length = text::Fixed(100 * seen_m, 1) + " cm";
  if (seen_m < kLeastSpanM)
    return InvalidData(std::string("the sphere ") + name + " is only " + length +
                       " from the first place: stretch the arm, 20 cm or more");
  if (known_m <= 0) return {};
  const double off_m = std::abs(seen_m - known_m);
  if (off_m <= kMostLengthOff * known_m || off_m <= 3 * std::sqrt(variance_m2)) return {};
  return InvalidData(std::string("the sphere ") + name + " is seen " + length +
                     " from the first place, and should be " + text::Fixed(100 * known_m, 1) +
                     " cm: the lens file or the sphere's radius is not the true one, or the sphere "
                     "was not in its place; measure again");
}

}  // namespace

Result<CameraPose> FromThreePoses(const ThreePoses& poses) {
  const Places places = {poses.origin.p_C_m, poses.ahead.p_C_m, poses.left.p_C_m};
  const Vector3d ahead = places[1] - places[0], left = places[2] - places[0];
  const auto variance_m2 = [&](const SeenPoint& to) {
    return SpanVarianceM2(poses.origin, to, poses.placement_sd_m);
  };
  if (auto wrong = WrongSpan("ahead", ahead.norm(), poses.ahead_m, variance_m2(poses.ahead)))
    return *std::move(wrong);
  if (auto wrong = WrongSpan("to the left", left.norm(), poses.left_m, variance_m2(poses.left)))
    return *std::move(wrong);
  const double angle = std::acos(std::clamp(ahead.normalized().dot(left.normalized()), -1.0, 1.0));
  if (!(angle >= DegreesToRadians(60) && angle <= DegreesToRadians(120)))
    return InvalidData("the second and the third place are " +
                       text::Fixed(RadiansToDegrees(angle), 0) +
                       " degrees apart as seen from the first, 60 to 120 are needed: point "
                       "straight ahead, then straight to the left");
  CameraPose pose;
  pose.X_WC = PoseOf(places, poses.p_WO_m);
  if (pose.X_WC.linear()(2, 1) > 0)
    return InvalidData(
        "the camera would stand on its head: the image is mirrored, or the third place was to the "
        "right. Switch mirroring off in the camera, and point to the left");
  pose.covariance = CovarianceOf(places, poses);
  pose.residuals_m = {0, 0, std::abs(left.norm() * std::cos(angle))};
  pose.residual_rms_m = pose.residuals_m[2] / std::sqrt(3.0);
  return pose;
}

}  // namespace footing::camera_pose
