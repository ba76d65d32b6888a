#pragma once

#include "common/stream/character.h"
#include "daemon/simulation/biped/body_state.h"
#include "daemon/simulation/physics/world.h"

namespace footing::engine {

/// The house's definition of a fall; put-backs count besides.
inline constexpr double kLowestBodyM = 0.55;
inline constexpr double kLargestTiltRad = 1.0471975511965976;  ///< 60 degrees.

/// Why this state is a fall, as text of static storage; null when it is none.
const char* WhyFallen(const stream::Track& track, const biped::BodyState& body,
                      const physics::Observation& seen);

}  // namespace footing::engine
