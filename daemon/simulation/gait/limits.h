#pragma once

#include "daemon/simulation/biped/command.h"

namespace footing::gait {

/// The command within the range in which its gait was found stable (docs/gait.md); one that is not
/// finite, or of no known gait, is stepping in place.
biped::GaitCommand Limited(const biped::GaitCommand& command);

}  // namespace footing::gait
