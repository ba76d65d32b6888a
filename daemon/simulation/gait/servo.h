#pragma once

#include "daemon/simulation/biped/body_state.h"
#include "daemon/simulation/gait/gains.h"
#include "daemon/simulation/gait/memory.h"
#include "daemon/simulation/gait/targets.h"
#include "daemon/simulation/biped/world.h"

namespace footing::gait {

/// Yaw, roll, pitch and joint length of a leg whose foot is r_HF_B from its hip, yaw 0.
std::array<double, 4> LegInverseKinematics(const biped::BipedParameters& biped,
                                           const Eigen::Vector3d& r_HF_B_m);

/// The PD servos: joint efforts that pursue the targets. Placed legs follow their joint targets
/// with the targets' rate fed forward, supporting legs carry the body. `memory.servo` is updated.
physics::JointEfforts Servo(const Targets& targets, const biped::BodyState& body,
                            const biped::BipedParameters& biped, const Gains& gains, double step_s,
                            GaitMemory& memory);

}  // namespace footing::gait
