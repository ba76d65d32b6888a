#pragma once

#include <string>
#include <vector>

#include "common/plot/line_plot.h"
#include "common/stream/character.h"
#include "daemon/offline/eval/report.h"

namespace footing::eval {

/// `tracks`: a synthetic user steers along a track through an interface.
void AddTracksCommand(CLI::App& app, Shared& shared);

/// A track seen from above: surface, slopes, steps, pits, and the lines of a trial.
plot::PlanPanel PlanOf(const std::string& name, const stream::Track& track);

/// The colours that PlanOf uses.
std::vector<plot::PlanKey> PlanKeys();

/// `plan`: draws tracks as seen from above.
void AddPlanCommand(CLI::App& app, Shared& shared);

}  // namespace footing::eval
