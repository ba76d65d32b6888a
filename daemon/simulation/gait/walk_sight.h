#pragma once

#include <optional>

#include "daemon/simulation/gait/context.h"
#include "daemon/simulation/gait/walk_plan.h"

/// Walking and stepping at the pit that LookForPit found (pit_sight.h): over a narrow one by its
/// footholds; before a wide one they stop.
namespace footing::gait {

/// The coming foothold at a pit, seen from the supporting foot; nothing when it needs no plan.
/// `natural_m` is the foothold without a pit.
std::optional<WalkPlan> StepAtPit(const Context& context, const GaitMemory& memory,
                                  const PitAhead& pit, const WalkAhead& walk, double natural_m);

/// The speed at which a walk still stops before a pit that it may not cross, or slows down for one
/// that it steps over; infinite when it may go on as it does.
double SpeedBeforePit(const Context& context, const GaitMemory& memory);

}  // namespace footing::gait
