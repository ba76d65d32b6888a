#pragma once

#include "daemon/simulation/biped/body_state.h"

namespace footing::gait {

/// Angular momentum of both legs about the whole COM, world axes, kg m2 / s.
Eigen::Vector3d LegsMomentum(const biped::BodyState& body, const biped::BipedParameters& biped);

/// Angular momentum of body and legs about the whole COM, world axes, kg m2 / s. The rotors of the
/// hip drives are left out. In flight it is constant: what a push or a stance leaves of it turns
/// the body until the next foot is down, whatever the hips do.
Eigen::Vector3d AngularMomentum(const biped::BodyState& body, const biped::BipedParameters& biped);

}  // namespace footing::gait
