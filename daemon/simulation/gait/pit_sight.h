#pragma once

#include <optional>

#include "daemon/simulation/gait/context.h"
#include "daemon/simulation/gait/pit_plan.h"

/// Running and jumping towards a pit: finds it on the track, measures the hops, and turns the plan
/// (pit_plan.h) into what the gaits remember.
namespace footing::gait {

/// At lift-off and touchdown: remembers the pit ahead, if any.
void LookForPit(const Context& context, GaitMemory& memory);

/// The remembered pit as seen from a point, along the heading.
std::optional<PitAhead> PitFrom(const GaitMemory& memory, const Eigen::Vector3d& p_W_m);

/// At touchdown and lift-off: measures the hop, for the next one's prediction.
void NoteTouchdown(const Context& context, GaitMemory& memory);
void NoteLiftOff(const Context& context, GaitMemory& memory);

/// At lift-off: whether the coming foothold is the last one before the pit. `nominal_mps` is the
/// vertical lift-off speed when nothing lies ahead.
void ForeseeLeap(const Context& context, double nominal_mps, GaitMemory& memory);

/// At the leg's shortest: the vertical lift-off speed, if the pit asks for another than the nominal
/// one.
void PlanLiftOff(const Context& context, double nominal_mps, GaitMemory& memory);

/// The spring's extension for a lift-off at this vertical speed, by what the last hops lost.
double PlannedExtension(const Context& context, double lift_off_mps, const GaitMemory& memory);

/// True in a run whose commanded jump waits for the pit ahead.
bool JumpsPit(const biped::GaitCommand& goal, const GaitMemory& memory);

/// In the flight of such a run: whether the coming foothold is the one to jump from. A run that is
/// too fast to jump crosses the pit in its stride.
bool JumpsFromNext(const Context& context, const GaitMemory& memory);

/// In flight: how far to move the foothold off the pit; m along the heading.
double FootholdShift(const Context& context, const GaitMemory& memory);

}  // namespace footing::gait
