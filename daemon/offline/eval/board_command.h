#pragma once

#include "daemon/offline/eval/command.h"

namespace footing::eval {

/// `footing-eval board`: measures of sway from a board's corners, or from a COP.
void AddBoardCommand(CLI::App& app, Shared& shared);

}  // namespace footing::eval
