#include "common/virtual/devices/kinect_skeleton.h"

#include <algorithm>
#include <cmath>

#include "common/body/skeleton_points.h"

namespace footing::virtual_sensors {

KinectErrors::KinectErrors(std::uint64_t seed) : random_(seed) {
  for (double& value : offset_m_) value = kOffsetM * random_.Normal();
}

void KinectErrors::Expose() {
  const double kept = std::exp(-kPeriodS / kOffsetChangesS);
  for (double& value : offset_m_) {
    value = kept * value + std::sqrt(1 - kept * kept) * kOffsetM * random_.Normal();
  }
}

Eigen::Vector3d KinectErrors::Measure(const Eigen::Vector3d& p_W_m, noise::Random& noise) const {
  Eigen::Vector3d measured_m = p_W_m + offset_m_;
  for (double& value : measured_m) value += kNoiseM * noise.Normal();
  return measured_m;
}

double KinectErrors::SdM() { return std::hypot(kNoiseM, kOffsetM); }

namespace {

using body::Landmark;
using stream::BodyJoint;

/// Half the thickness of the parts of a body over its height, by eye from anatomical proportions.
struct LimbShape {
  Landmark from, to;
  double of_height;
};
constexpr LimbShape kLimbs[] = {
    {Landmark::kHips, Landmark::kNeck, 0.065},
    {Landmark::kNeck, Landmark::kHead, 0.04},
    {Landmark::kLeftShoulder, Landmark::kLeftElbow, 0.027},
    {Landmark::kLeftElbow, Landmark::kLeftWrist, 0.021},
    {Landmark::kLeftHip, Landmark::kLeftKnee, 0.042},
    {Landmark::kLeftKnee, Landmark::kLeftAnkle, 0.03},
};
/// A part of the body hides what is behind it by more than this, beside its own thickness: joints
/// are within limbs, whose surface the camera sees.
constexpr double kBehindM = 0.06;
constexpr double kAwayM = 2.4, kHighM = 1;  // Where people put the camera.

/// The line of sight from `eye` to `p` passes through a limb from `a` to `b` that is before `p`.
bool Covers(const Eigen::Vector3d& eye, const Eigen::Vector3d& p, const Eigen::Vector3d& a,
            const Eigen::Vector3d& b, double radius_m) {
  const Eigen::Vector3d sight = (p - eye).normalized();
  const double range_m = (p - eye).norm();
  constexpr int kSteps = 8;
  for (int i = 0; i <= kSteps; ++i) {
    const Eigen::Vector3d axis = a + (b - a) * (static_cast<double>(i) / kSteps) - eye;
    const double along_m = axis.dot(sight);
    const double across_m = (axis - along_m * sight).norm();
    if (across_m < radius_m && along_m < range_m - radius_m - kBehindM) return true;
  }
  return false;
}

bool IsOfALeg(std::size_t point) {
  constexpr auto kFirst = KinectSkeleton::kHands + body::IndexOf(BodyJoint::kLeftHip);
  constexpr auto kLast = KinectSkeleton::kHands + body::IndexOf(BodyJoint::kRightFoot);
  return point >= kFirst && point <= kLast;
}

}  // namespace

KinectSkeleton::KinectSkeleton(const body::Body& body, std::uint64_t seed,
                               const KinectOptions& options)
    : options_(options),
      camera_W_m_(kAwayM * std::cos(options.yaw_rad), kAwayM * std::sin(options.yaw_rad), kHighM),
      errors_(seed),
      noise_(seed + 1'000'003) {
  for (int side = 0; side < 2; ++side) {
    points_[static_cast<std::size_t>(side)] = body::Fist(body, side);
    hips_[static_cast<std::size_t>(side)] = body.landmarks[body::OfSide(Landmark::kLeftHip, side)];
  }
  const auto joints = body::SkeletonPoints(body);
  std::copy(joints.begin(), joints.end(), points_.begin() + kHands);
  for (const LimbShape& shape : kLimbs) {
    for (int side = 0; side < 2; ++side) {
      const Limb limb{body.landmarks[body::OfSide(shape.from, side)],
                      body.landmarks[body::OfSide(shape.to, side)],
                      shape.of_height * body.height_m};
      const bool again = side == 1 && body::Mirrored(shape.to) == shape.to;
      if (limb.from >= 0 && limb.to >= 0 && !again) limbs_.push_back(limb);
    }
  }
  body::Kinematics at(body.skeleton);
  body::ComputeKinematics(body.skeleton, body::TPose(body.skeleton, body.landmarks), at);
  for (const int hip : hips_) standing_m_ += 0.5 * at.p_WJ[static_cast<std::size_t>(hip)].z();
  for (Eigen::Vector3d& wandering_m : wandering_m_)
    for (double& value : wandering_m) value = noise_.Normal();
}

bool KinectSkeleton::Crouches(const body::Kinematics& at) const {
  double height_m = 0;
  for (const int hip : hips_) height_m += 0.5 * at.p_WJ[static_cast<std::size_t>(hip)].z();
  return height_m < options_.crouch_share * standing_m_;
}

bool KinectSkeleton::IsHidden(std::size_t point, const body::Kinematics& at) const {
  const Eigen::Vector3d p_W_m = body::Place(points_[point], at);
  return std::any_of(limbs_.begin(), limbs_.end(), [&](const Limb& limb) {
    if (limb.from == points_[point].joint || limb.to == points_[point].joint) return false;
    return Covers(camera_W_m_, p_W_m, at.p_WJ[static_cast<std::size_t>(limb.from)],
                  at.p_WJ[static_cast<std::size_t>(limb.to)], limb.radius_m);
  });
}

const std::array<KinectPoint, KinectSkeleton::kPoints>& KinectSkeleton::Expose(
    const body::Kinematics& at) {
  errors_.Expose();
  crouches_ = Crouches(at);
  const double kept = std::exp(-KinectErrors::kPeriodS / KinectErrors::kOffsetChangesS);
  // Deviation that makes three times the deviation of all errors out of those that a seen joint
  // has.
  const double inferred_m = std::sqrt(kInferredFactor * kInferredFactor - 1) * KinectErrors::SdM();
  for (std::size_t i = 0; i < kPoints; ++i) {
    KinectPoint& point = seen_[i];
    point.true_W_m = body::Place(points_[i], at);
    point.p_W_m =
        i < kHands ? errors_.Measure(point.true_W_m) : errors_.Measure(point.true_W_m, noise_);
    point.hidden = options_.hides && ((crouches_ && IsOfALeg(i)) || IsHidden(i, at));
    point.sd_m = (point.hidden ? kInferredFactor : 1) * KinectErrors::SdM();
    for (double& value : wandering_m_[i])
      value = kept * value + std::sqrt(1 - kept * kept) * noise_.Normal();
    if (point.hidden) point.p_W_m += inferred_m * wandering_m_[i];
  }
  return seen_;
}

}  // namespace footing::virtual_sensors
