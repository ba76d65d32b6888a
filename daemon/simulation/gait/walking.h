#pragma once

#include "daemon/simulation/gait/context.h"
#include "daemon/simulation/gait/targets.h"

namespace footing::gait {

/// What Figure 5's machine asks of the present state.
WalkingCues SenseWalking(const Context& context, const GaitMemory& memory);

/// Control laws of the present state: walking, and stepping as walking at no speed.
Targets WalkingTargets(const Context& context, const GaitMemory& memory);

/// One step of walking or stepping: cues, transition, foothold, targets. A thrust that begins is
/// left to AdvanceRunning: then `memory.transition.thrusting` is set and the targets are empty.
Targets AdvanceWalking(const Context& context, GaitMemory& memory);

}  // namespace footing::gait
