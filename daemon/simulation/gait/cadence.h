#pragma once

#include "daemon/simulation/gait/context.h"

/// Steps at the user's own rate, as far as a gait stays robust: subjects of the paper missed "a
/// tight coupling between running speed and stepping speed". A command without cadence leaves each
/// gait its own.
namespace footing::gait {

/// Rise and Fall of the present step, s. Equation (1) follows it, so the speed stays.
double SwingTime(const Context& context, const GaitMemory& memory);
/// The same for the step that begins, by the command.
double CommandedSwingTime(const Context& context);
/// Vertical speed of a run's lift-off, m/s: flight takes the step's time less the support's.
double RunLiftOffSpeed(const Context& context, const GaitMemory& memory);

}  // namespace footing::gait
