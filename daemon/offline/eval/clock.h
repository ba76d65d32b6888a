#pragma once

#include "daemon/offline/eval/report.h"

namespace footing::eval {

/// `footing-eval clock`: estimated sample times against the link model's true device clock.
void AddClockCommand(CLI::App& app, Shared& shared);

}  // namespace footing::eval
