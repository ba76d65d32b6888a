#pragma once

#include "daemon/offline/eval/command.h"

namespace footing::eval {

/// footing-eval sphere: positions of the spheres in the frames of a folder.
void AddSphereCommand(CLI::App& app, Shared& shared);

}  // namespace footing::eval
