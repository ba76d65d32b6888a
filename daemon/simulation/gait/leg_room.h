#pragma once

#include "daemon/simulation/gait/context.h"
#include "daemon/simulation/gait/targets.h"

namespace footing::gait {

/// Keeps a run's idle leg out of the other one: where they would be less than
/// CurveGains::leg_gap_m apart sideways, and no further fore and aft, its target turns outwards.
/// After a push to the side the idle leg's swing takes up what would turn the body over, and goes
/// first.
void KeepLegsApart(const Context& context, const GaitMemory& memory, Targets& targets);

}  // namespace footing::gait
