#pragma once

#include <string>
#include <vector>

#include "daemon/simulation/biped/parameters.h"
#include "daemon/simulation/biped/world.h"

namespace footing::biped {

/// The whole world as MJCF text: options, `ground` (geoms of the world body), the biped.
/// Contact: the feet's friction holds whatever ground they touch; solref 6 ms, critically damped.
/// The feet and the geoms of `ground_names` are also listed as pairs (physics/clearance.h).
std::string WriteMjcf(const BipedParameters& parameters, const std::string& ground,
                      const std::vector<std::string>& ground_names, double step_s);

/// The names WriteMjcf gives, and those of the ground's boxes that may be moved.
physics::WorldNames Names(const std::vector<std::string>& ground = {});

}  // namespace footing::biped
