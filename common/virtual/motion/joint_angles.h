#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "common/base/result.h"
#include "common/body/body.h"
#include "common/virtual/motion/motion.h"
#include "common/virtual/motion/table.h"

/// Joint angles of a body, as the exports write them and evaluations score them.
namespace footing::joint_angles {

/// Angles of the joints, degrees, and the root's position, m, under the names that the coordinates
/// have in the full-body model of Rajagopal et al. 2016; 0 in the upright body with hanging arms.
///
/// Every joint is a rotation about z, then x, then y of the parent's frame, as in that model. With
/// the anatomical axes of the ISB (x ahead, y up, z right) these are the angles of the joint
/// coordinate systems of Grood & Suntay 1983 and Wu et al. 2002 and 2005: flexion about z of the
/// upper segment, rotation about y of the lower one, adduction about the line across both. Signs
/// are OpenSim's: flexion, adduction, internal rotation and raised toes are positive; pelvis and
/// trunk tilt backwards, list to the right and turn left by positive angles.
///
/// The elbow bends about z of the upper arm: where z lies in the arm is found from the frame in
/// which the elbow is bent most. InvalidData where the skeleton has no joint of a name that is
/// known.
///
/// Two triples of angles describe the same rotation. The one nearest to the frame before is taken,
/// or, to compare two motions, the one nearest to the same frame of `near` (null: none).
Result<motion::Table> JointAngles(const motion::Motion& motion,
                                  const motion::Motion* near = nullptr);

// The change from a person's own standing. What a skeleton, a set of markers or a laboratory's
// model takes for upright differs by up to 25 degrees, most of all for the pelvis, and cancels out
// in it.

/// The rows from `from` on, in which the person stands still and upright: knees and hips are bent
/// by less than 40 degrees, and for 0.3 s around no angle of pelvis, hips, knees or trunk changes
/// by more than 4. None where there are no such rows, or columns are missing.
std::vector<Eigen::Index> FindStanding(const motion::Table& angles, Eigen::Index from = 0);

/// The angles of pelvis, trunk and legs, degrees, of a table of JointAngles() or of OpenSim's
/// inverse kinematics, as the change from the mean of the rows `standing`, of which there are some:
/// the anatomical frames of all segments are upright there and look where the pelvis looks.
/// Columns: the time, and those of JointAngles() without arms and places. InvalidData where a
/// column is missing.
Result<motion::Table> SinceStanding(const motion::Table& angles,
                                    const std::vector<Eigen::Index>& standing);

/// In a leg that is straighter than this, hip and knee turn about one line, and only markers on the
/// skin can separate the two: the rotation of the hip is not known from other sensors.
inline constexpr double kStraightKneeDeg = 20;

/// Whether the angle of a column is known in a row, by that rule.
bool IsKnown(const motion::Table& angles, const std::string& column, Eigen::Index row);

/// The person as a model for OpenSim (.osim, format 4.0), whose coordinates are the angles of
/// JointAngles(): twelve rigid bodies with the lengths of the skeleton and with masses, centres of
/// mass and inertias as of body::MakeBody, joined as those angles say, and the skeleton's joints as
/// markers under their names. It has no muscles and no geometry. The trunk is one body above the
/// lowest joint of the back. InvalidData as of JointAngles() and MakeBody().
Result<std::string> OpenSimModel(const motion::Motion& motion, const body::PersonParameters& person,
                                 const std::string& name);

/// Name of the body of OpenSimModel() on which a foot's ground force acts.
inline const char* OpenSimFoot(bool left) { return left ? "calcn_l" : "calcn_r"; }

}  // namespace footing::joint_angles
