#pragma once

#include "daemon/offline/eval/command.h"

namespace footing::eval {

/// footing-eval hand: where a tracked hand is between frames and while it is hidden.
void AddHandCommand(CLI::App& app, Shared& shared);

}  // namespace footing::eval
