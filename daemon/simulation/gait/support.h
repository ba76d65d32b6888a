#pragma once

#include "daemon/simulation/biped/body_state.h"
#include "daemon/simulation/gait/gains.h"
#include "daemon/simulation/gait/targets.h"
#include "daemon/simulation/biped/world.h"

namespace footing::gait {

/// Hip efforts of the supporting legs, so that all hips and leg forces together put `moment_W_nm`
/// on the body. Fed forward: the moment of the leg forces about the body's COM (hip spacing times
/// three body weights is 40 N m) and the reaction of the other legs' hips, whose efforts must
/// already be in `efforts`. `axial_n` holds the support legs' forces along the leg.
///
/// A foot is a point: torque across the leg is limited by friction, torque along it by torsional
/// friction, both at the load the foot really carries. What both feet could turn more, they do by
/// fore-aft forces against each other.
void CarryBody(const biped::BodyState& body, const biped::BipedParameters& biped,
               const AttitudeGains& gains, const Targets& targets, double heading_rad,
               const Eigen::Vector3d& moment_W_nm, const std::array<double, 2>& axial_n,
               physics::JointEfforts& efforts);

}  // namespace footing::gait
