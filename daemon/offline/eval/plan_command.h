#pragma once

#include "daemon/offline/eval/command.h"

namespace footing::eval {

/// `plan`: draws tracks as seen from above.
void AddPlanCommand(CLI::App& app, Shared& shared);

}  // namespace footing::eval
