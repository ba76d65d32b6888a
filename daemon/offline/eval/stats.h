#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "daemon/offline/eval/report.h"

namespace footing::eval {

/// `footing-eval stats`: treatments against a control.
void AddStatsCommand(CLI::App& app, Shared& shared);

/// A report of common/statistics as text for people: a table of its rows, then the note.
std::string StatsText(const nlohmann::ordered_json& report);

}  // namespace footing::eval
