#include "clients/skeleton/tracking/placement.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "common/base/units.h"

namespace footing::skeleton {
namespace {

using Eigen::Vector3d;

Vector3d Middle(const Skeleton& skeleton, Joint left) {
  return 0.5 * (skeleton[left].p_K_m + skeleton[Mirrored(left)].p_K_m);
}

Vector3d Leftward(const Skeleton& skeleton, Joint left) {
  return skeleton[left].p_K_m - skeleton[Mirrored(left)].p_K_m;
}

bool IsWhole(const Skeleton& skeleton) {
  for (const Joint left : {Joint::kLeftShoulder, Joint::kLeftHip, Joint::kLeftFoot})
    if (!skeleton[left].present() || !skeleton[Mirrored(left)].present()) return false;
  return skeleton[Joint::kNeck].present();
}

/// Of the angle within which a person by whose left and right the camera is behind has swapped
/// sides. Somebody who stands sideways may be right.
constexpr double kBehindCosine = 0.5;

std::string Number(double value) { return std::to_string(static_cast<int>(std::lround(value))); }

}  // namespace

Eigen::Isometry3d ToPose(const CameraPlace& place) {
  Eigen::Matrix3d looks_along_x;  // K's x is left, y up, z ahead.
  looks_along_x << 0, 0, 1, 1, 0, 0, 0, 1, 0;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = (Eigen::AngleAxisd(place.yaw_rad, Vector3d::UnitZ()) *
                   Eigen::AngleAxisd(-place.pitch_rad, Vector3d::UnitY()) *
                   Eigen::AngleAxisd(place.roll_rad, Vector3d::UnitX()))
                      .toRotationMatrix() *
                  looks_along_x;
  pose.translation() = place.p_W_m;
  return pose;
}

Result<StandingFit> FitStanding(std::span<const Skeleton> frames, const CameraPlace& known,
                                bool by_camera) {
  StandingFit fit{.place = known};
  fit.place.yaw_rad = 0;
  fit.place.p_W_m.setZero();
  // A frame that is level, with the camera's unknown yaw.
  const Eigen::Matrix3d R_LK = ToPose(fit.place).linear();
  Vector3d left = Vector3d::Zero(), trunk = Vector3d::Zero(), feet = Vector3d::Zero();
  Vector3d toes = Vector3d::Zero();
  std::vector<Vector3d> all;
  for (const Skeleton& frame : frames) {
    if (!IsWhole(frame)) continue;
    left += R_LK * (Leftward(frame, Joint::kLeftShoulder) + Leftward(frame, Joint::kLeftHip));
    trunk += R_LK * (frame[Joint::kNeck].p_K_m - Middle(frame, Joint::kLeftHip));
    all.push_back(R_LK * Middle(frame, Joint::kLeftFoot));
    feet += all.back();
    toes += R_LK * frame.toes_K_m.value_or(Vector3d::Zero());
  }
  if (all.empty() || all.size() < frames.size() / 2)
    return Failure("placement: the camera must see shoulders, hips and feet; step back");
  feet /= static_cast<double>(all.size());
  double square_m2 = 0;
  for (const Vector3d& one : all) square_m2 += (one - feet).squaredNorm() / 3;
  fit.scatter_m = std::sqrt(square_m2 / static_cast<double>(all.size()));
  if (fit.scatter_m > kMostScatterM) return Failure("placement: the feet moved; stand still");
  fit.lean_rad = std::acos(std::clamp(trunk.normalized().z(), -1.0, 1.0));
  if (fit.lean_rad > kMostLeanRad) {
    return Failure("placement: the trunk leans by " + Number(RadiansToDegrees(fit.lean_rad)) +
                   " degrees; stand upright, or give the camera's tilt with --camera-pitch-deg "
                   "and --camera-roll-deg");
  }
  // The yaw that turns left to W's y.
  fit.place.yaw_rad = std::atan2(left.x(), left.y());
  if (toes.dot(left.cross(Vector3d::UnitZ())) < 0) {
    return Failure(
        "placement: the toes point back, so left and right are swapped; start with --swap-sides, "
        "and with --mirrored too if raising the left hand then raises the right");
  }
  if (by_camera && std::cos(fit.place.yaw_rad) > kBehindCosine) {
    return Failure(
        "placement: by left and right the person turns the back to the camera: face the camera; if "
        "you do, left and right are swapped: start with --swap-sides");
  }
  const Vector3d feet_W = Eigen::AngleAxisd(fit.place.yaw_rad, Vector3d::UnitZ()) * feet;
  fit.place.p_W_m = Vector3d(0, 0, kAnkleHeightM) - feet_W;
  return fit;
}

}  // namespace footing::skeleton
