#pragma once

#include "daemon/offline/eval/command.h"

namespace footing::eval {

/// `tracks`: a synthetic user steers along a track through an interface.
void AddTracksCommand(CLI::App& app, Shared& shared);

}  // namespace footing::eval
