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

/// In Extension: counts steps that look like lift-off, where the leg is at its rest length (a light
/// foot may well stay on the ground then) or off the ground, and notes which leg left it first.
void WatchExtension(const Context& context, GaitMemory& memory);

/// Nothing has left the ground yet in the Extension that begins.
void BeginExtension(HopSupport& hop);

/// In a jump's Extension: both legs pushed, and one has left the ground. "The second leg is
/// retracted to initiate flight."
bool OneLegLeft(const GaitMemory& memory);

/// In an absorbing Compression: the vertical speed is taken out.
bool LandingDone(const Context& context, const GaitMemory& memory);

/// Length of a jump's second leg that is "extended to make contact" once the other has landed, m.
double ReachingLength(const Context& context);

}  // namespace footing::gait
