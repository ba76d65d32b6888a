#pragma once

#include "daemon/offline/eval/command.h"

namespace footing::eval {

/// footing-eval fusion: a camera's skeleton and the boards, in squats that hide the legs.
void AddFusionCommand(CLI::App& app, Shared& shared);

}  // namespace footing::eval
