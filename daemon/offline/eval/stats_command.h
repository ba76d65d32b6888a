#pragma once

#include "daemon/offline/eval/command.h"

namespace footing::eval {

/// `footing-eval stats`: treatments against a control.
void AddStatsCommand(CLI::App& app, Shared& shared);

}  // namespace footing::eval
