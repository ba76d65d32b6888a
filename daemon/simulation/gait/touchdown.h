#pragma once

#include "daemon/simulation/gait/context.h"

namespace footing::gait {

/// At every touchdown: turns the heading by the commanded increment, counts the step, and corrects
/// the gait's foothold by the speed error over the step just made, once the command has settled.
/// (Integrating while the speed is still changing winds up and ends in vaulting.)
void CountStep(const Context& context, GaitMemory& memory);

}  // namespace footing::gait
