#include "common/body/momentum.h"

#include <Eigen/Geometry>

#include "common/base/result.h"

namespace footing::body {
namespace {

Eigen::Vector3d CentreOf(const JointMass& mass, const Kinematics& at, std::size_t joint) {
  return at.p_WJ[joint] + at.R_WJ[joint] * mass.com_J;
}

/// I_W w for a body-fixed inertia.
Eigen::Vector3d Spin(const JointMass& mass, const Eigen::Matrix3d& R_WJ, const Eigen::Vector3d& w) {
  return R_WJ * (mass.inertia_J * (R_WJ.transpose() * w));
}

}  // namespace

CompositeMasses::CompositeMasses(const Skeleton& skeleton)
    : mass_kg(skeleton.joints.size(), 0.0),
      first_W(skeleton.joints.size(), Eigen::Vector3d::Zero()),
      inertia_W(skeleton.joints.size(), Eigen::Matrix3d::Zero()) {}

Eigen::Vector3d CentreOfMass(const Body& body, const Kinematics& at) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < body.masses.size(); ++i) {
    const JointMass& mass = body.masses[i];
    if (mass.mass_kg > 0) sum += mass.mass_kg * CentreOf(mass, at, i);
  }
  return sum / body.mass_kg;
}

Momentum ComputeMomentum(const Body& body, const Kinematics& at,
                         const JointVelocities& velocities) {
  // About the root first, which is near: then moved to C.
  const Eigen::Vector3d origin = at.p_WJ[0];
  Eigen::Vector3d first = Eigen::Vector3d::Zero();
  Momentum sum;
  for (std::size_t i = 0; i < body.masses.size(); ++i) {
    const JointMass& mass = body.masses[i];
    if (!(mass.mass_kg > 0)) continue;
    const Eigen::Vector3d& w = velocities.w_WJ[i];
    const Eigen::Vector3d arm = at.R_WJ[i] * mass.com_J;
    const Eigen::Vector3d place = at.p_WJ[i] + arm - origin;
    const Eigen::Vector3d linear = mass.mass_kg * (velocities.v_WJ[i] + w.cross(arm));
    first += mass.mass_kg * place;
    sum.linear_W += linear;
    sum.angular_W += place.cross(linear) + Spin(mass, at.R_WJ[i], w);
  }
  const Eigen::Vector3d centre = first / body.mass_kg;
  sum.p_WC = origin + centre;
  sum.angular_W -= centre.cross(sum.linear_W);
  return sum;
}

MomentumRate ComputeMomentumRate(const Body& body, const Kinematics& at,
                                 const JointVelocities& velocities,
                                 const JointAccelerations& accelerations) {
  const Eigen::Vector3d origin = at.p_WJ[0];
  Eigen::Vector3d first = Eigen::Vector3d::Zero();
  MomentumRate sum;
  for (std::size_t i = 0; i < body.masses.size(); ++i) {
    const JointMass& mass = body.masses[i];
    if (!(mass.mass_kg > 0)) continue;
    const Eigen::Vector3d& w = velocities.w_WJ[i];
    const Eigen::Vector3d& alpha = accelerations.alpha_WJ[i];
    const Eigen::Vector3d arm = at.R_WJ[i] * mass.com_J;
    const Eigen::Vector3d place = at.p_WJ[i] + arm - origin;
    const Eigen::Vector3d force =
        mass.mass_kg * (accelerations.a_WJ[i] + alpha.cross(arm) + w.cross(w.cross(arm)));
    first += mass.mass_kg * place;
    sum.linear_W += force;
    sum.angular_W +=
        place.cross(force) + Spin(mass, at.R_WJ[i], alpha) + w.cross(Spin(mass, at.R_WJ[i], w));
  }
  sum.angular_W -= (first / body.mass_kg).cross(sum.linear_W);
  return sum;
}

Eigen::Vector3d ComputeCentroidalMatrix(const Body& body, const Kinematics& at,
                                        CompositeMasses& workspace, CentroidalMatrix& out) {
  const Skeleton& skeleton = body.skeleton;
  FOOTING_CHECK(out.cols() == skeleton.dof);
  const Eigen::Vector3d centre = CentreOfMass(body, at);
  for (std::size_t i = 0; i < skeleton.joints.size(); ++i) {
    const JointMass& mass = body.masses[i];
    workspace.mass_kg[i] = mass.mass_kg;
    if (!(mass.mass_kg > 0)) {
      workspace.first_W[i].setZero();
      workspace.inertia_W[i].setZero();
      continue;
    }
    const Eigen::Vector3d d = CentreOf(mass, at, i) - centre;
    workspace.first_W[i] = mass.mass_kg * d;
    const Eigen::Matrix3d half = at.R_WJ[i] * mass.inertia_J;
    workspace.inertia_W[i].noalias() = half * at.R_WJ[i].transpose();
    workspace.inertia_W[i] -= mass.mass_kg * d * d.transpose();
    workspace.inertia_W[i].diagonal().array() += mass.mass_kg * d.squaredNorm();
  }
  for (std::size_t i = skeleton.joints.size() - 1; i > 0; --i) {
    const auto parent = static_cast<std::size_t>(skeleton.joints[i].parent);
    workspace.mass_kg[parent] += workspace.mass_kg[i];
    workspace.first_W[parent] += workspace.first_W[i];
    workspace.inertia_W[parent] += workspace.inertia_W[i];
  }
  out.leftCols<3>().setZero();
  out.topLeftCorner<3, 3>().diagonal().setConstant(body.mass_kg);
  for (std::size_t i = 0; i < skeleton.joints.size(); ++i) {
    const Joint& joint = skeleton.joints[i];
    const Eigen::Vector3d arm = centre - at.p_WJ[i];
    const int end = joint.first_dof + static_cast<int>(joint.rotations.size());
    for (int dof = joint.first_dof; dof < end; ++dof) {
      const Eigen::Vector3d& axis = at.axis_W[static_cast<std::size_t>(dof)];
      out.col(dof).head<3>() = axis.cross(workspace.first_W[i] + workspace.mass_kg[i] * arm);
      out.col(dof).tail<3>() =
          workspace.inertia_W[i] * axis + workspace.first_W[i].cross(axis.cross(arm));
    }
  }
  return centre;
}

Eigen::Vector3d ComJacobian(const Body& body, const Kinematics& at, CompositeMasses& workspace,
                            JacobianRef out) {
  const Skeleton& skeleton = body.skeleton;
  FOOTING_CHECK(out.cols() == skeleton.dof);
  for (std::size_t i = 0; i < skeleton.joints.size(); ++i) {
    const JointMass& mass = body.masses[i];
    workspace.mass_kg[i] = mass.mass_kg;
    workspace.first_W[i].setZero();  // From the root, as far as this function goes.
    if (mass.mass_kg > 0)
      workspace.first_W[i] = mass.mass_kg * (CentreOf(mass, at, i) - at.p_WJ[0]);
  }
  for (std::size_t i = skeleton.joints.size() - 1; i > 0; --i) {
    const auto parent = static_cast<std::size_t>(skeleton.joints[i].parent);
    workspace.mass_kg[parent] += workspace.mass_kg[i];
    workspace.first_W[parent] += workspace.first_W[i];
  }
  out.leftCols<3>().setIdentity();
  for (std::size_t i = 0; i < skeleton.joints.size(); ++i) {
    const Joint& joint = skeleton.joints[i];
    const Eigen::Vector3d moment =
        (workspace.first_W[i] - workspace.mass_kg[i] * (at.p_WJ[i] - at.p_WJ[0])) / body.mass_kg;
    const int end = joint.first_dof + static_cast<int>(joint.rotations.size());
    for (int dof = joint.first_dof; dof < end; ++dof) {
      out.col(dof) = at.axis_W[static_cast<std::size_t>(dof)].cross(moment);
    }
  }
  return at.p_WJ[0] + workspace.first_W[0] / body.mass_kg;
}

}  // namespace footing::body
