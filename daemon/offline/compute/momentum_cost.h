#pragma once

#include <Eigen/Core>

#include "common/body/body.h"

namespace footing::timing {

/// Microseconds of CPU time of forward kinematics, centre of mass and momentum of a pose: the unit
/// of the pose solver's cost.
double MomentumCostUs(const body::Body& body, const Eigen::VectorXd& q);

}  // namespace footing::timing
