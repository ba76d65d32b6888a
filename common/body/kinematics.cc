#include "common/body/kinematics.h"

#include <Eigen/Geometry>
#include <cmath>

#include "common/base/result.h"

namespace footing::body {
namespace {

std::size_t Index(int value) { return static_cast<std::size_t>(value); }

/// R = R * R(axis, angle), on two columns only.
void RotateColumns(Axis axis, double angle_rad, Eigen::Matrix3d& R) {
  const double cosine = std::cos(angle_rad), sine = std::sin(angle_rad);
  const int i = (static_cast<int>(axis) + 1) % 3, j = (static_cast<int>(axis) + 2) % 3;
  const Eigen::Vector3d first = R.col(i), second = R.col(j);
  R.col(i) = cosine * first + sine * second;
  R.col(j) = cosine * second - sine * first;
}

/// One joint, whose parent is placed already.
inline void Place(const Skeleton& skeleton, const PoseRef& q, std::size_t i, Kinematics& out) {
  const Joint& joint = skeleton.joints[i];
  Eigen::Matrix3d& R = out.R_WJ[i];
  if (joint.parent < 0) {
    R = joint.axes;
    out.p_WJ[i] = q.head<3>();
  } else {
    const std::size_t parent = Index(joint.parent);
    out.p_WJ[i].noalias() = out.p_WJ[parent] + out.R_WJ[parent] * joint.offset_m;
    if (joint.rotations.empty()) {
      R = out.R_WJ[parent];
      return;
    }
    if (joint.plain_axes) {
      R = out.R_WJ[parent];
    } else {
      R.noalias() = out.R_WJ[parent] * joint.axes;
    }
  }
  int dof = joint.first_dof;
  for (const Rotation& rotation : joint.rotations) {
    out.axis_W[Index(dof)] = R.col(static_cast<int>(rotation.axis));
    RotateColumns(rotation.axis, q(dof), R);
    ++dof;
  }
  if (!joint.plain_axes) R = (R * joint.axes.transpose()).eval();
}

}  // namespace

Kinematics::Kinematics(const Skeleton& skeleton)
    : R_WJ(Index(skeleton.size()), Eigen::Matrix3d::Identity()),
      p_WJ(Index(skeleton.size()), Eigen::Vector3d::Zero()),
      axis_W(Index(skeleton.dof), Eigen::Vector3d::Zero()) {}

JointVelocities::JointVelocities(const Skeleton& skeleton)
    : w_WJ(Index(skeleton.size()), Eigen::Vector3d::Zero()),
      v_WJ(Index(skeleton.size()), Eigen::Vector3d::Zero()) {}

JointAccelerations::JointAccelerations(const Skeleton& skeleton)
    : alpha_WJ(Index(skeleton.size()), Eigen::Vector3d::Zero()),
      a_WJ(Index(skeleton.size()), Eigen::Vector3d::Zero()) {}

void ComputeKinematics(const Skeleton& skeleton, PoseRef q, Kinematics& out) {
  FOOTING_CHECK(q.size() == skeleton.dof);
  for (int axis = 0; axis < 3; ++axis) out.axis_W[Index(axis)] = Eigen::Vector3d::Unit(axis);
  for (std::size_t i = 0; i < skeleton.joints.size(); ++i) Place(skeleton, q, i, out);
}

void ComputeKinematics(const Skeleton& skeleton, PoseRef q, std::span<const int> joints,
                       Kinematics& out) {
  FOOTING_CHECK(q.size() == skeleton.dof);
  for (const int joint : joints) Place(skeleton, q, Index(joint), out);
}

void ComputeVelocities(const Skeleton& skeleton, const Kinematics& at, PoseRef q_dot,
                       JointVelocities& out) {
  FOOTING_CHECK(q_dot.size() == skeleton.dof);
  for (std::size_t i = 0; i < skeleton.joints.size(); ++i) {
    const Joint& joint = skeleton.joints[i];
    Eigen::Vector3d w = Eigen::Vector3d::Zero();
    if (joint.parent < 0) {
      out.v_WJ[i] = q_dot.head<3>();
    } else {
      const std::size_t parent = Index(joint.parent);
      w = out.w_WJ[parent];
      out.v_WJ[i] = out.v_WJ[parent] + w.cross(at.p_WJ[i] - at.p_WJ[parent]);
    }
    const int end = joint.first_dof + static_cast<int>(joint.rotations.size());
    for (int dof = joint.first_dof; dof < end; ++dof) w += at.axis_W[Index(dof)] * q_dot(dof);
    out.w_WJ[i] = w;
  }
}

void ComputeAccelerations(const Skeleton& skeleton, const Kinematics& at, PoseRef q_dot,
                          PoseRef q_ddot, const JointVelocities& velocities,
                          JointAccelerations& out) {
  FOOTING_CHECK(q_dot.size() == skeleton.dof && q_ddot.size() == skeleton.dof);
  for (std::size_t i = 0; i < skeleton.joints.size(); ++i) {
    const Joint& joint = skeleton.joints[i];
    Eigen::Vector3d w = Eigen::Vector3d::Zero(), alpha = Eigen::Vector3d::Zero();
    if (joint.parent < 0) {
      out.a_WJ[i] = q_ddot.head<3>();
    } else {
      const std::size_t parent = Index(joint.parent);
      w = velocities.w_WJ[parent];
      alpha = out.alpha_WJ[parent];
      const Eigen::Vector3d arm = at.p_WJ[i] - at.p_WJ[parent];
      out.a_WJ[i] = out.a_WJ[parent] + alpha.cross(arm) + w.cross(w.cross(arm));
    }
    // Each axis is rotated by the rotations before it.
    const int end = joint.first_dof + static_cast<int>(joint.rotations.size());
    for (int dof = joint.first_dof; dof < end; ++dof) {
      const Eigen::Vector3d turn = at.axis_W[Index(dof)] * q_dot(dof);
      alpha += at.axis_W[Index(dof)] * q_ddot(dof) + w.cross(turn);
      w += turn;
    }
    out.alpha_WJ[i] = alpha;
  }
}

void PointJacobian(const Skeleton& skeleton, const Kinematics& at, int joint,
                   const Eigen::Vector3d& p_W, JacobianRef out) {
  FOOTING_CHECK(out.cols() == skeleton.dof);
  out.setZero();
  out.leftCols<3>().setIdentity();
  for (int i = joint; i >= 0; i = skeleton.joint(i).parent) {
    const Joint& link = skeleton.joint(i);
    const Eigen::Vector3d arm = p_W - at.p_WJ[Index(i)];
    const int end = link.first_dof + static_cast<int>(link.rotations.size());
    for (int dof = link.first_dof; dof < end; ++dof)
      out.col(dof) = at.axis_W[Index(dof)].cross(arm);
  }
}

void OrientationJacobian(const Skeleton& skeleton, const Kinematics& at, int joint,
                         JacobianRef out) {
  FOOTING_CHECK(out.cols() == skeleton.dof);
  out.setZero();
  for (int i = joint; i >= 0; i = skeleton.joint(i).parent) {
    const Joint& link = skeleton.joint(i);
    const int end = link.first_dof + static_cast<int>(link.rotations.size());
    for (int dof = link.first_dof; dof < end; ++dof) out.col(dof) = at.axis_W[Index(dof)];
  }
}

}  // namespace footing::body
