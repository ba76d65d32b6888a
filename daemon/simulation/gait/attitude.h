#pragma once

#include <Eigen/Core>

#include "daemon/simulation/biped/body_state.h"
#include "daemon/simulation/gait/gains.h"
#include "daemon/simulation/gait/memory.h"
#include "daemon/simulation/gait/targets.h"

namespace footing::gait {

/// The moment (world frame, N m) that a PD servo on roll, pitch and yaw wants on the body: level,
/// along the heading and turning as it does; jumping leans back with speed, running banks in
/// curves.
Eigen::Vector3d BodyMoment(const biped::BodyState& body, const GaitMemory& memory,
                           const Targets& targets, const AttitudeGains& gains);

/// Roll, rad, at which a run goes through the present curve: to the left negative.
double BankAngle(const GaitMemory& memory, const AttitudeGains& gains);

/// Roll of the body about the heading, rad; to the left negative.
double Roll(const biped::BodyState& body, const GaitMemory& memory);
/// The same beyond the bank: what a push leaves.
double TiltAside(const biped::BodyState& body, const GaitMemory& memory,
                 const AttitudeGains& gains);

}  // namespace footing::gait
