#pragma once

#include <Eigen/Core>

#include "daemon/simulation/biped/body_state.h"
#include "daemon/simulation/gait/gains.h"
#include "daemon/simulation/gait/memory.h"
#include "daemon/simulation/gait/targets.h"

namespace footing::gait {

/// The moment (world frame, N m) that a PD servo on roll, pitch and yaw wants on the body: level,
/// along the heading and turning as it does; jumping leans back with speed.
Eigen::Vector3d BodyMoment(const biped::BodyState& body, const GaitMemory& memory,
                           const Targets& targets, const AttitudeGains& gains);

}  // namespace footing::gait
