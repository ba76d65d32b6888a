#pragma once

#include "daemon/offline/eval/command.h"

namespace footing::eval {

/// `features`: the features of recorded accelerations, or how good the features are on synthetic
/// motion.
void AddFeaturesCommand(CLI::App& app, Shared& shared);

}  // namespace footing::eval
