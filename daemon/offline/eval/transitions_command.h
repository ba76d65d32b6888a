#pragma once

#include "daemon/offline/eval/command.h"

namespace footing::eval {

/// `transitions`: from one gait to another, from random speeds, heights and moments.
void AddTransitionsCommand(CLI::App& app, Shared& shared);

}  // namespace footing::eval
