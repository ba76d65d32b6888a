#include "common/virtual/motion/reference_pose.h"

#include <algorithm>
#include <cmath>

#include "common/body/body.h"
#include "common/body/kinematics.h"
#include "common/base/units.h"

namespace footing::motion {
namespace {

using body::Landmark;
using Eigen::Vector3d;

constexpr Eigen::Index kEnoughFrames = 2000;  // Of a long motion, evenly spread.

Eigen::Index Stride(const Motion& motion) {
  return std::max<Eigen::Index>(1, motion.frames() / kEnoughFrames);
}

/// Places of landmarks in one pose.
class Places {
 public:
  Places(const Motion& motion, const body::Landmarks& landmarks)
      : skeleton_(motion.skeleton), landmarks_(landmarks), at_(motion.skeleton) {}

  void Take(const Eigen::VectorXd& q) { body::ComputeKinematics(skeleton_, q, at_); }
  const Vector3d& At(Landmark landmark) const { return at_.p_WJ[Index(landmark)]; }
  const Eigen::Matrix3d& Turn(Landmark landmark) const { return at_.R_WJ[Index(landmark)]; }
  Vector3d Line(Landmark from, Landmark to) const { return (At(to) - At(from)).normalized(); }
  /// Of the line from the right hip to the left one.
  Vector3d Left() const { return Line(Landmark::kRightHip, Landmark::kLeftHip); }
  Vector3d Up() const {
    const Vector3d hips = 0.5 * (At(Landmark::kLeftHip) + At(Landmark::kRightHip));
    return (At(Landmark::kNeck) - hips).normalized();
  }
  /// Cosines of how far trunk and legs are from the vertical: their least, and their sum.
  std::pair<double, double> Uprightness() const {
    double least = Up().z(), sum = Up().z();
    for (const int side : {0, 1}) {
      const auto of = [side](Landmark left) { return body::OfSide(left, side); };
      for (const auto& [from, to] : {std::pair{Landmark::kLeftHip, Landmark::kLeftKnee},
                                     {Landmark::kLeftKnee, Landmark::kLeftAnkle}}) {
        const double down = -Line(of(from), of(to)).z();
        least = std::min(least, down);
        sum += down;
      }
    }
    return {least, sum};
  }

 private:
  std::size_t Index(Landmark landmark) const {
    return static_cast<std::size_t>(landmarks_[landmark]);
  }

  const body::Skeleton& skeleton_;
  const body::Landmarks& landmarks_;
  body::Kinematics at_;
};

/// A standing person who looks along x, arms wherever.
bool IsPerson(const Places& places) {
  constexpr double kNear = 0.8;  // Some 37 degrees.
  return places.Uprightness().first > kNear && places.Left().y() > kNear;
}

/// The skeleton's pose turned about the vertical so that its hips stand along y.
Eigen::VectorXd Facing(const Motion& motion, const Places& places, Eigen::VectorXd q) {
  const Vector3d left = places.Left();
  const Eigen::Matrix3d turn =
      body::AxisRotation(body::Axis::kZ, kPi / 2 - std::atan2(left.y(), left.x()));
  const body::Joint& root = motion.skeleton.joint(0);
  body::SetJointRotation(root, turn * body::JointRotation(root, q), q);
  return q;
}

/// The side towards which a hinge's axis points, over the motion.
class Hinge {
 public:
  /// `sign` is 1 where upper x lower points to the lateral side, else -1.
  Hinge(Landmark from, Landmark joint, Landmark to, double sign)
      : from_(from), joint_(joint), to_(to), sign_(sign) {}

  void Take(const Places& places) {
    const Vector3d bent = places.Line(from_, joint_).cross(places.Line(joint_, to_));
    const double sine = bent.norm();
    // A straight limb has no plane. Weighed by itself, since it is known the better.
    if (!(sine > kLeastSine)) return;
    sum_J_ += places.Turn(from_).transpose() * (sign_ * sine * bent);
    weight_ += sine * sine;
  }
  /// In W, with the joints as they are now.
  Vector3d Lateral(const Places& places, const Vector3d& otherwise_W) const {
    const bool agreed = weight_ > 0 && sum_J_.norm() > kLeastAgreement * weight_;
    Vector3d axis_W = agreed ? Vector3d(places.Turn(from_) * sum_J_) : otherwise_W;
    const Vector3d bone_W = places.Line(from_, joint_);
    axis_W -= bone_W * bone_W.dot(axis_W);
    return axis_W.normalized();
  }

 private:
  static constexpr double kLeastSine = 0.26;  // 15 degrees.
  static constexpr double kLeastAgreement = 0.7;

  Landmark from_, joint_, to_;
  double sign_;
  Vector3d sum_J_ = Vector3d::Zero();
  double weight_ = 0;
};

}  // namespace

Eigen::VectorXd ReferencePose(const Motion& motion, const body::Landmarks& landmarks) {
  Places places(motion, landmarks);
  Eigen::VectorXd q = body::TPose(motion.skeleton, landmarks);
  places.Take(q);
  if (IsPerson(places) || motion.frames() == 0) return q;
  Eigen::Index best = 0;
  double most = -10;  // Below every sum of five cosines.
  for (Eigen::Index i = 0; i < motion.frames(); i += Stride(motion)) {
    places.Take(motion.q.col(i));
    const double upright = places.Uprightness().second;
    if (upright > most) {
      most = upright;
      best = i;
    }
  }
  q = motion.q.col(best);
  places.Take(q);
  return Facing(motion, places, q);
}

HingeAxes FindHingeAxes(const Motion& motion, const body::Landmarks& landmarks,
                        const Eigen::VectorXd& pose) {
  const auto hinge = [](Landmark from, Landmark joint, Landmark to, int side, double left_sign) {
    return Hinge(body::OfSide(from, side), body::OfSide(joint, side), body::OfSide(to, side),
                 side == 0 ? left_sign : -left_sign);
  };
  // A knee bends its shank backwards, an elbow the forearm forwards.
  std::array<Hinge, 2> knees = {
      hinge(Landmark::kLeftHip, Landmark::kLeftKnee, Landmark::kLeftAnkle, 0, 1),
      hinge(Landmark::kLeftHip, Landmark::kLeftKnee, Landmark::kLeftAnkle, 1, 1)};
  std::array<Hinge, 2> elbows = {
      hinge(Landmark::kLeftShoulder, Landmark::kLeftElbow, Landmark::kLeftWrist, 0, -1),
      hinge(Landmark::kLeftShoulder, Landmark::kLeftElbow, Landmark::kLeftWrist, 1, -1)};
  Places places(motion, landmarks);
  for (Eigen::Index i = 0; i < motion.frames(); i += Stride(motion)) {
    places.Take(motion.q.col(i));
    for (std::size_t side = 0; side < 2; ++side) {
      knees[side].Take(places);
      elbows[side].Take(places);
    }
  }
  places.Take(pose);
  HingeAxes axes;
  for (std::size_t side = 0; side < 2; ++side) {
    const Vector3d out(0, side == 0 ? 1 : -1, 0);
    axes.knee_W[side] = knees[side].Lateral(places, out);
    axes.elbow_W[side] = elbows[side].Lateral(places, -Vector3d::UnitX());
  }
  return axes;
}

}  // namespace footing::motion
