#include "common/virtual/motion/half_turns.h"

#include <Eigen/Geometry>

#include "common/body/landmarks.h"
#include "common/units/angle.h"
#include "common/units/units.h"

namespace footing::motion {
namespace {

using body::Joint;
using body::Landmark;

/// A thigh of three angles, a shank of one that hangs on it, and the foot.
class Leg {
 public:
  Leg(const body::Skeleton& skeleton, const body::Landmarks& landmarks, int side)
      : hip_(&skeleton.joint(landmarks[body::OfSide(Landmark::kLeftHip, side)])),
        knee_index_(landmarks[body::OfSide(Landmark::kLeftKnee, side)]),
        knee_(&skeleton.joint(knee_index_)),
        ankle_(&skeleton.joint(landmarks[body::OfSide(Landmark::kLeftAnkle, side)])) {}

  /// The ankle hangs on the knee, which hangs on the hip, and lies in the plane of its hinge.
  bool HasHinge(const body::Landmarks& landmarks, int side) const {
    return hip_->rotations.size() == 3 && knee_->rotations.size() == 1 &&
           knee_->parent == landmarks[body::OfSide(Landmark::kLeftHip, side)] &&
           ankle_->parent == knee_index_ && knee_->offset_m.norm() > 0;
  }

  /// Takes the solution of `q` that is nearer to `before`.
  void Choose(const Eigen::VectorXd& before, Eigen::Ref<Eigen::VectorXd> q) const {
    const Eigen::Matrix3d was = JointRotation(*hip_, before), is = JointRotation(*hip_, q);
    const Eigen::Matrix3d half =
        Eigen::AngleAxisd(kPi, knee_->offset_m.normalized()).toRotationMatrix();
    if ((was.transpose() * is).trace() >= (was.transpose() * is * half).trace()) return;
    const Eigen::Matrix3d foot = is * JointRotation(*knee_, q) * JointRotation(*ankle_, q);
    SetJointRotation(*hip_, is * half, q);
    q(knee_->first_dof) = NearestTurn(-q(knee_->first_dof), before(knee_->first_dof));
    const Eigen::Matrix3d shank = is * half * JointRotation(*knee_, q);
    const auto turns = static_cast<int>(ankle_->rotations.size());
    q.segment(ankle_->first_dof, turns) = before.segment(ankle_->first_dof, turns);
    SetJointRotation(*ankle_, shank.transpose() * foot, q);
  }

 private:
  const Joint* hip_;
  int knee_index_;
  const Joint* knee_;
  const Joint* ankle_;
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
