#pragma once

#include "daemon/simulation/gait/context.h"
#include "daemon/simulation/gait/targets.h"

namespace footing::gait {

/// Keeps a run's idle leg out of the other one in a curve, where both lie aslant: where they would
/// be less than CurveGains::leg_gap_m apart sideways, and no further fore and aft, its target
/// turns outwards. A run straight ahead has space between its legs. After a push to the side the
/// idle leg's swing takes up what would turn the body over, and goes first.
void KeepLegsApart(const Context& context, const GaitMemory& memory, Targets& targets);

}  // namespace footing::gait
