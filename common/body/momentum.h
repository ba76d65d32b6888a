#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/body/body.h"
#include "common/body/kinematics.h"

namespace footing::body {

/// Centre of mass C and momentum of the whole body. Angular momentum and its rate are about C.
struct Momentum {
  Eigen::Vector3d p_WC = Eigen::Vector3d::Zero();       ///< m.
  Eigen::Vector3d linear_W = Eigen::Vector3d::Zero();   ///< kg m/s.
  Eigen::Vector3d angular_W = Eigen::Vector3d::Zero();  ///< kg m^2/s.
};

/// Time derivative of the momentum: the sum of all outer forces, and of their moments about C.
struct MomentumRate {
  Eigen::Vector3d linear_W = Eigen::Vector3d::Zero();   ///< N. Contacts give this less m g.
  Eigen::Vector3d angular_W = Eigen::Vector3d::Zero();  ///< N m.
};

/// Six rows (linear, then angular about C) and a column a degree of freedom.
using CentroidalMatrix = Eigen::Matrix<double, 6, Eigen::Dynamic>;

/// Workspace for the composites of ComputeCentroidalMatrix; the caller owns it.
struct CompositeMasses {
  explicit CompositeMasses(const Skeleton& skeleton);

  std::vector<double> mass_kg;
  std::vector<Eigen::Vector3d> first_W;    ///< Mass times centre, from the body's C; kg m.
  std::vector<Eigen::Matrix3d> inertia_W;  ///< About the body's C; kg m^2.
};

Eigen::Vector3d CentreOfMass(const Body& body, const Kinematics& at);

Momentum ComputeMomentum(const Body& body, const Kinematics& at, const JointVelocities& velocities);

MomentumRate ComputeMomentumRate(const Body& body, const Kinematics& at,
                                 const JointVelocities& velocities,
                                 const JointAccelerations& accelerations);

/// Centroidal momentum matrix A, (linear, angular) = A q_dot, by composites of the subtrees (Orin,
/// Goswami and Lee 2013, "Centroidal dynamics of a humanoid robot"). `out` has dof columns. Returns
/// C.
Eigen::Vector3d ComputeCentroidalMatrix(const Body& body, const Kinematics& at,
                                        CompositeMasses& workspace, CentroidalMatrix& out);

/// d p_WC / dq: the linear rows of A over the mass.
Eigen::Vector3d ComJacobian(const Body& body, const Kinematics& at, CompositeMasses& workspace,
                            JacobianRef out);

}  // namespace footing::body
