#pragma once

#include "daemon/simulation/gait/controller.h"
#include "daemon/simulation/gait/targets.h"

/// How a gait moves beyond what keeps it up: docs/gait.md, "Style".
namespace footing::gait {

/// Hips over their mean height, m: lowest at touchdown, highest in the middle of the step, as over
/// a rigid leg, whose arc over a step of length s is s^2 / (8 h).
double HipRise(const Context& context, const GaitMemory& memory);

/// The pelvis within a step (StyleGains), and its rates: set-points of a walk's targets.
void AddStyle(const Context& context, const GaitMemory& memory, Targets& targets);

/// Whether nothing has pushed the body out of its gait (FadeGains).
bool IsRegular(const Context& context, const GaitMemory& memory);

/// Share of the style, [0, 1], that leaves balance alone: less in a turn, and none while a pit is
/// in sight, the ground is uneven, another gait is commanded, or the state is not regular, as after
/// a push (FadeGains).
double RegularShare(const Context& context, const GaitMemory& memory);

/// Leads `memory.style.share` to RegularShare. While it falls, the present step of a walk gets
/// shorter, too: the part that is over stays.
void FadeStyle(const Context& context, GaitMemory& memory);

}  // namespace footing::gait
