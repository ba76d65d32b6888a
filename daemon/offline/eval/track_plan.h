#pragma once

#include <string>
#include <vector>

#include "common/stream/character.h"
#include "daemon/offline/analysis/plan_plot.h"

namespace footing::eval {

/// A track seen from above: surface, slopes, steps, pits, and the lines of a trial.
plot::PlanPanel PlanOf(const std::string& name, const stream::Track& track);

/// The colours that PlanOf uses.
std::vector<plot::PlanKey> PlanKeys();

}  // namespace footing::eval
