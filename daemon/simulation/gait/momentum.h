#pragma once

#include "daemon/simulation/gait/context.h"

namespace footing::gait {

/// Angular momentum of both legs about the whole COM, kg m2/s, world.
Eigen::Vector3d LegsMomentum(const biped::BodyState& body, const biped::BipedParameters& biped);

/// Angular momentum of the whole body about its COM, kg m2/s, world. In flight it does not change.
Eigen::Vector3d AngularMomentum(const biped::BodyState& body, const biped::BipedParameters& biped);

}  // namespace footing::gait
