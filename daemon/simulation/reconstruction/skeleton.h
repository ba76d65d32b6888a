#pragma once

#include <Eigen/Core>

#include "common/body/kinematics.h"
#include "daemon/simulation/pose/targets.h"
#include "daemon/simulation/reconstruction/inputs.h"
#include "daemon/simulation/reconstruction/subject_model.h"

/// Joints of a tracked skeleton, such as a Kinect's (pose paper, sections 5.3 and 7.3): what of
/// them is believed, and the terms of the solver that they are.
namespace footing::reconstruction {

/// Enough joints are valid to show the pose. Fewer, such as a tracked head, add to what boards and
/// hands show.
bool IsSkeleton(const JointInputs& joints);

/// A term for each valid joint, which shows its one of `points`, with its covariance. A joint that
/// is not seen has none.
void AddJointTargets(const JointPoints& points, const JointInputs& joints,
                     pose::PoseTargets& targets);

/// A joint that is far from where the last pose, `at` in W, has it counts less, the less the
/// further; one that is implausibly far, or not finite, is not valid. Where many are implausibly
/// far it is the pose that is wrong, and none is dropped for that.
void GateJoints(const JointPoints& points, const body::Kinematics& at, JointInputs& joints);

/// What all joints are off by in common, as a camera that stands not quite where it was found to
/// stand makes them. Feet and COM stand still in W, so it is learned from what the joints are off
/// from the pose that follows all of these. Of a few joints it would be what the pose is off by.
/// A value.
class SkeletonOffset {
 public:
  void Start() { offset_m_.setZero(); }
  /// The inputs without it: joints, and the hands that the same tracker alone
  /// sees: another one knows a hand better than the offset is known.
  Inputs Without(const Inputs& inputs) const;
  /// One frame: `joints` by Without, and gated; `at` in W is the pose that was solved for them.
  void Learn(const JointPoints& points, const JointInputs& joints, const body::Kinematics& at,
             double step_s);
  const Eigen::Vector3d& offset_m() const { return offset_m_; }

 private:
  Eigen::Vector3d offset_m_ = Eigen::Vector3d::Zero();
};

}  // namespace footing::reconstruction
