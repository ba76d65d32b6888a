#pragma once

#include "daemon/simulation/biped/command.h"

/// The commands under which each gait was found stable (docs/gait.md).
namespace footing::biped {

/// The largest turn of a step at any speed: what a mapping may ask for.
inline constexpr double kTurnPerStepMaxDeg = 8;

/// The largest turn of a step, rad, by gait and speed: a faster gait turns less.
double TurnLimit(stream::Gait gait, double speed_mps);

/// The command within the range in which its gait was found stable; one that is not finite, or of
/// no known gait, is stepping in place.
GaitCommand Limited(const GaitCommand& command);

}  // namespace footing::biped
