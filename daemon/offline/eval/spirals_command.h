#pragma once

#include "daemon/offline/eval/command.h"

namespace footing::eval {

/// footing-eval spirals: the trainer of cascades on the field's own test problem.
void AddSpiralsCommand(CLI::App& app, Shared& shared);

}  // namespace footing::eval
