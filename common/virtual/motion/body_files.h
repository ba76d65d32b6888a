#pragma once

#include <array>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "common/base/result.h"
#include "common/virtual/motion/markers.h"
#include "common/virtual/motion/motion.h"
#include "common/virtual/motion/table.h"

/// A reconstructed body as motion files hold it, beside BVH and the table of joint angles.
namespace footing::motion {

/// The joints of every frame, in the axes of TRC files (OpenSim: x ahead, y up, z right), from 0 s.
/// They are not seen in a frame that is not `valid`.
MarkerTracks JointPlaces(const Motion& motion, const std::vector<bool>& valid);

// Forces under the feet of a reconstructed body, a table for OpenSim (.mot). Axes: x ahead, y up,
// z right.

/// Ground reaction on one foot: upward force, N, at a point of the floor.
struct FootForce {
  double load_n = 0;
  Eigen::Vector3d cop_W = Eigen::Vector3d::Zero();  ///< m.
};

/// Left, right.
using FootForces = std::array<FootForce, 2>;

/// Ground forces, a row for each of `forces`, from 0 s on: ground_force_r_vx, ... Only the vertical
/// force is known; the others and the free moments are 0.
Table ForceTable(const std::vector<FootForces>& forces, double rate_hz);

/// A table of OpenSim with a line for people in its header, which readers pass over.
std::string WithNote(std::string table, const std::string& note);

/// Joint angles for people who plot them, CSV: time_s, valid, then NAME_change_deg of pelvis, trunk
/// and legs, the change from where the person stands still (joint_angles::SinceStanding), and
/// NAME_deg of all angles of a table of joint_angles::JointAngles(). A cell is empty where the
/// frame is not `valid` or the angle is not known (joint_angles::IsKnown); without a still stand
/// there are no columns of changes.
Result<std::string> AnglesCsv(const Table& angles, const std::vector<bool>& valid);

/// Says to OpenSim's tools which columns of "NAME_grf.mot" (ForceTable) act on which foot.
std::string ExternalLoads(const std::string& name);

/// A reconstructed body as a C3D file holds it: the centres of the joints as points, the forces
/// under the feet as two force plates. Axes: W (x ahead, y left, z up).
///
/// Plate 1 is the left foot, plate 2 the right one. Both are one rectangle of the floor that holds
/// all centres of pressure, and of type 2: three forces on the person and three moments about the
/// rectangle's middle, in axes x ahead, y right, z down. Only the vertical force and the moments
/// that it causes are known; the others are 0. Without `forces` there is no plate. The points of a
/// frame that is not `valid` are not seen.
C3d ToC3d(const Motion& motion, const std::vector<bool>& valid,
          const std::vector<FootForces>& forces);

}  // namespace footing::motion
