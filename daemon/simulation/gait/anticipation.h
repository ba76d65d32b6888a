#pragma once

#include "daemon/simulation/gait/context.h"

/// What shows of a command before physics can follow it: "a visible anticipation at once". Both are
/// set-points of servos that run anyway, small enough not to disturb the balance.
namespace footing::gait {

/// Pitch of the body, rad, forward positive, for the speed that v_d has still to gain.
double AnticipatedLean(const Context& context, const GaitMemory& memory);

/// How much lower the hips of a walk go, m, that waits for its Fall to jump.
double AnticipatedCrouch(const Context& context, const GaitMemory& memory);

}  // namespace footing::gait
