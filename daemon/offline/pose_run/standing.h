#pragma once

#include <Eigen/Core>
#include <string>

#include "common/base/result.h"
#include "common/virtual/motion/motion.h"
#include "common/virtual/motion/table.h"
#include "daemon/offline/pose_run/pose_run.h"

/// Plates against markers, by somebody who stands still on them.
namespace footing::pose_run {

/// How far the body's centre of mass is from over the plates' centre of pressure, in the mean of a
/// trial in which a person stands still, where one must be over the other: along x and y of the
/// files' W, m. What plates, markers and the masses of segments are wrong by together. InvalidData
/// when motion and forces have less than a second in common, the person moves or is half supported
/// by something else, or both are further apart than any such error.
Result<Eigen::Vector2d> StandingOffset(const motion::Motion& still,
                                       const motion::GroundForces& forces, const Settings& settings,
                                       const std::string& origin, const std::string& forces_origin);

}  // namespace footing::pose_run
