#pragma once

#include "daemon/offline/eval/command.h"

namespace footing::eval {

/// `gait`: trials of one gait at one command, each kicked.
void AddGaitCommand(CLI::App& app, Shared& shared);

}  // namespace footing::eval
