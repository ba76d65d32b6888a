#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "common/body/skeleton.h"

namespace footing::body {

/// Places of all joints in one pose. The caller owns it; made once for a skeleton, then nothing
/// below allocates.
struct Kinematics {
  explicit Kinematics(const Skeleton& skeleton);

  std::vector<Eigen::Matrix3d> R_WJ;
  std::vector<Eigen::Vector3d> p_WJ;    ///< m.
  std::vector<Eigen::Vector3d> axis_W;  ///< Of each degree of freedom: the axis of its motion.
};

/// Velocities of all joints' frames, of their origins.
struct JointVelocities {
  explicit JointVelocities(const Skeleton& skeleton);

  std::vector<Eigen::Vector3d> w_WJ;  ///< rad/s.
  std::vector<Eigen::Vector3d> v_WJ;  ///< m/s.
};

/// Accelerations of all joints' frames, of their origins.
struct JointAccelerations {
  explicit JointAccelerations(const Skeleton& skeleton);

  std::vector<Eigen::Vector3d> alpha_WJ;  ///< rad/s^2.
  std::vector<Eigen::Vector3d> a_WJ;      ///< m/s^2.
};

/// Forward kinematics. `q` has skeleton.dof entries.
void ComputeKinematics(const Skeleton& skeleton, PoseRef q, Kinematics& out);
/// The same for these joints alone, parents first; what is not among them is in `out` already.
void ComputeKinematics(const Skeleton& skeleton, PoseRef q, std::span<const int> joints,
                       Kinematics& out);

/// `q_dot` is the time derivative of the coordinates, entry for entry (of Euler angles: not the
/// angular velocity).
void ComputeVelocities(const Skeleton& skeleton, const Kinematics& at, PoseRef q_dot,
                       JointVelocities& out);
void ComputeAccelerations(const Skeleton& skeleton, const Kinematics& at, PoseRef q_dot,
                          PoseRef q_ddot, const JointVelocities& velocities,
                          JointAccelerations& out);

/// A matrix of three rows and a column a degree of freedom, or a block of one.
using JacobianRef = Eigen::Ref<Eigen::Matrix<double, 3, Eigen::Dynamic>, 0, Eigen::OuterStride<>>;

/// d p_W / dq of a point fixed to the frame of `joint` that is now at `p_W`. For the joint's own
/// origin `p_W` is at.p_WJ[joint].
void PointJacobian(const Skeleton& skeleton, const Kinematics& at, int joint,
                   const Eigen::Vector3d& p_W, JacobianRef out);

/// w_WJ = J q_dot.
void OrientationJacobian(const Skeleton& skeleton, const Kinematics& at, int joint,
                         JacobianRef out);

}  // namespace footing::body
