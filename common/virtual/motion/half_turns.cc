#include "common/virtual/motion/half_turns.h"

#include <Eigen/Geometry>
#include <cmath>

#include "common/body/landmarks.h"
#include "common/base/angle.h"
#include "common/base/units.h"

namespace footing::motion {
namespace {

using body::Joint;
using body::Landmark;

constexpr double kStraight = 1e-3;  // Sine of an angle that counts as none.

/// A thigh of three angles, a shank of one that hangs on it, and the foot.
class Leg {
 public:
  Leg(const body::Skeleton& skeleton, const body::Landmarks& landmarks, int side)
      : hip_(&skeleton.joint(landmarks[body::OfSide(Landmark::kLeftHip, side)])),
        knee_index_(landmarks[body::OfSide(Landmark::kLeftKnee, side)]),
        knee_(&skeleton.joint(knee_index_)),
        ankle_(&skeleton.joint(landmarks[body::OfSide(Landmark::kLeftAnkle, side)])),
        along_(knee_->offset_m.normalized()),
        half_(Eigen::AngleAxisd(kPi, along_)) {}

  /// The ankle hangs on the knee, which hangs on the hip, in one line with both at rest and across
  /// the hinge: else the other solution has the ankle elsewhere.
  bool HasHinge(const body::Landmarks& landmarks, int side) const {
    if (hip_->rotations.size() != 3 || knee_->rotations.size() != 1 ||
        knee_->parent != landmarks[body::OfSide(Landmark::kLeftHip, side)] ||
        ankle_->parent != knee_index_ || !(knee_->offset_m.norm() > 0)) {
      return false;
    }
    const Eigen::Vector3d hinge = knee_->axes.col(static_cast<int>(knee_->rotations[0].axis));
    return ankle_->offset_m.normalized().cross(along_).norm() < kStraight &&
           std::abs(hinge.dot(along_)) < kStraight;
  }

  /// Takes the solution of `q` that is nearer to `before`.
  void Choose(const Eigen::VectorXd& before, Eigen::Ref<Eigen::VectorXd> q) const {
    const Eigen::Matrix3d was = JointRotation(*hip_, before), is = JointRotation(*hip_, q);
    const Eigen::Matrix3d turned = is * half_;
    if ((was.transpose() * is).trace() >= (was.transpose() * turned).trace()) return;
    const Eigen::Matrix3d foot = is * JointRotation(*knee_, q) * JointRotation(*ankle_, q);
    SetJointRotation(*hip_, turned, q);
    q(knee_->first_dof) = NearestTurn(-q(knee_->first_dof), before(knee_->first_dof));
    const Eigen::Matrix3d shank = turned * JointRotation(*knee_, q);
    const auto turns = static_cast<int>(ankle_->rotations.size());
    q.segment(ankle_->first_dof, turns) = before.segment(ankle_->first_dof, turns);
    SetJointRotation(*ankle_, shank.transpose() * foot, q);
  }

 private:
  const Joint* hip_;
  int knee_index_;
  const Joint* knee_;
  const Joint* ankle_;
  Eigen::Vector3d along_;  ///< The thigh, in its frame.
  Eigen::Matrix3d half_;   ///< Half a turn about it.
};

}  // namespace

Motion WithoutHalfTurns(Motion motion) {
  const auto landmarks = body::FindLandmarks(motion.skeleton);
  if (!landmarks) return motion;
  for (int side = 0; side < 2; ++side) {
    const Leg leg(motion.skeleton, *landmarks, side);
    if (!leg.HasHinge(*landmarks, side)) continue;
    for (Eigen::Index frame = 1; frame < motion.frames(); ++frame) {
      leg.Choose(motion.q.col(frame - 1), motion.q.col(frame));
    }
  }
  return motion;
}

}  // namespace footing::motion
