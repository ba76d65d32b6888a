#pragma once

#include "common/body/body.h"
#include "common/virtual/motion/motion.h"
#include "common/virtual/devices/ground_reaction.h"

namespace footing::virtual_sensors {

/// React of a motion from markers, with as little smoothing as each moment needs: 6 Hz on angles
/// and 8 Hz on accelerations where forces change slowly, up to 10 and 12 Hz where both differ by
/// more than 5 % of the weight for a tenth of a second (a landing). `smooth` is Follow(body,
/// motion) at 6 Hz. For comparison with plates.
GroundReaction ReactToImpacts(const body::Body& body, const motion::Motion& motion,
                              const BodyCourse& smooth);

}  // namespace footing::virtual_sensors
