#pragma once

#include "daemon/offline/eval/command.h"

namespace footing::eval {

/// `momentum`: centre of mass, angular momentum and feet from simulated boards under a motion.
void AddMomentumCommand(CLI::App& app, Shared& shared);

}  // namespace footing::eval
