#pragma once

#include "daemon/simulation/gait/context.h"
#include "daemon/simulation/gait/targets.h"

namespace footing::gait {

/// Keeps a run's idle leg out of the other one: where they would be less than
/// CurveGains::leg_gap_m apart sideways, and no further fore and aft, its target turns outwards,
/// in a curve from a little before they pass each other.
/// After a push to the side the idle leg's swing takes up what would turn the body over, and goes
/// first.
void KeepLegsApart(const Context& context, const GaitMemory& memory, Targets& targets);

/// How far outside of the supporting foot a walk's swing foot is put that would balance the body
/// `outward_m` outside: at least the gap, until balance asks for a foothold beyond the other foot's
/// line. From there on it crosses, and from a gap beyond it on it lands where balance asks. What a
/// foothold is kept outside, the next one makes good.
double SideStep(double outward_m, double gap_m);

}  // namespace footing::gait
