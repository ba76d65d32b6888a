#pragma once

#include <CLI/CLI.hpp>

#include "daemon/offline/eval/command.h"

namespace footing::eval {

/// `footing-eval replay FILE.mcap`: runs a recording's raw reports and engine inputs again, at
/// their stamps, and compares the features and the biped's state hashes with the recorded ones bit
/// for bit. Exit code 1 when something differs, 4 when the recording holds nothing to run again.
void AddReplayCommand(CLI::App& app, Shared& shared);

}  // namespace footing::eval
