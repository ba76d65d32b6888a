#pragma once

#include "daemon/simulation/gait/controller.h"
#include "daemon/simulation/gait/targets.h"

namespace footing::gait {

/// Cues that Figure 6's machine needs of the present state.
RunningCues SenseRunning(const Context& context, const GaitMemory& memory);

/// Control laws of the present state. Jumping has the same with both legs as one virtual leg
/// (Raibert et al. 1986): the first foot to land waits for the other, which is lengthened.
Targets RunningTargets(const Context& context, const GaitMemory& memory);

/// One step of running, jumping, or of the thrust in Fall that leads there. When an absorbing
/// Compression ends, `memory.gait` is walking or stepping and the targets are empty.
Targets AdvanceRunning(const Context& context, GaitMemory& memory);

}  // namespace footing::gait
