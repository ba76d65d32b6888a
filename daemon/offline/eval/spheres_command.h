#pragma once

#include "daemon/offline/eval/command.h"

namespace footing::eval {

/// footing-eval spheres: errors of the sphere finder on rendered frames, by distance and condition.
void AddSpheresCommand(CLI::App& app, Shared& shared);

}  // namespace footing::eval
