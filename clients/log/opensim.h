#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "common/virtual/motion/table.h"

/// Forces under the feet of a reconstructed body, a table for OpenSim (.mot). Axes: x ahead, y up,
/// z right.
namespace footing::log_client {

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
