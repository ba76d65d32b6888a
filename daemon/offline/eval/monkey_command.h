#pragma once

#include "daemon/offline/eval/command.h"

namespace footing::eval {

/// `monkey`: a random gait, speed, height and turn every 0.5 to 4 s.
void AddMonkeyCommand(CLI::App& app, Shared& shared);

}  // namespace footing::eval
