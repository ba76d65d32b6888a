#pragma once

#include "daemon/offline/eval/command.h"

namespace footing::eval {

/// `pose`: the whole body from simulated boards and hands under a motion.
void AddPoseCommand(CLI::App& app, Shared& shared);

}  // namespace footing::eval
