#pragma once

#include "daemon/offline/eval/command.h"

namespace footing::eval {

/// footing-eval arm: the arms from a Wiimote in each hand under a motion, against the truth.
void AddArmCommand(CLI::App& app, Shared& shared);

}  // namespace footing::eval
