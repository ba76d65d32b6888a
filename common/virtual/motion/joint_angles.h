#pragma once

#include <string>

#include "common/base/result.h"
#include "common/body/body.h"
#include "common/virtual/motion/motion.h"
#include "common/virtual/motion/table.h"

/// Joint angles of a body, as the exports write them and evaluations score them.
namespace footing::joint_angles {

/// Angles of the joints, degrees, and the root's position, m, under the names that the coordinates
/// have in the full-body model of Rajagopal et al. 2016; 0 in the upright body with hanging arms.
///
/// Every joint is a rotation about z, then x, then y of the parent's frame, as in that model. The
/// elbow bends about z of the upper arm: where z lies in the arm is found from the frame in which
/// the elbow is bent most. InvalidData where the skeleton has no joint of a name that is known.
///
/// Two triples of angles describe the same rotation. The one nearest to the frame before is taken,
/// or, to compare two motions, the one nearest to the same frame of `near` (null: none).
Result<motion::Table> JointAngles(const motion::Motion& motion,
                                  const motion::Motion* near = nullptr);

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
