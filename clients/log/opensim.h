#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "common/result/result.h"
#include "common/virtual/motion/motion.h"
#include "common/virtual/motion/table.h"

/// Tables for OpenSim (.mot) of a reconstructed body. Axes: x ahead, y up, z right.
namespace footing::log_client {

/// Angles of the joints, degrees, and the root's position, m, under the names that the coordinates
/// have in the full-body model of Rajagopal et al. 2016; 0 in the upright body with hanging arms.
///
/// Every joint is a rotation about z, then x, then y of the parent's frame, as in that model. The
/// elbow bends about z of the upper arm: where z lies in the arm is found from the frame in which
/// the elbow is bent most. InvalidData where the skeleton has no joint of a name that is known.
Result<motion::Table> JointAngles(const motion::Motion& motion);

/// What carries a foot: force upwards at a point of the floor.
struct FootForce {
  double load_n = 0;
  Eigen::Vector3d cop_W = Eigen::Vector3d::Zero();  ///< m.
};

/// Left, right.
using FootForces = std::array<FootForce, 2>;

/// Ground forces, a row for each of `forces`, from 0 s on: ground_force_r_vx, ... Only the vertical
/// force is known; the others and the free moments are 0.
motion::Table ForceTable(const std::vector<FootForces>& forces, double rate_hz);

}  // namespace footing::log_client
