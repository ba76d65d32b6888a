#pragma once

#include <optional>

#include "daemon/simulation/footing_sim/config.h"

namespace footing::footing_sim {

/// Reads the command line and the config file into `config` and starts the log. The exit code when
/// the program should end now: after --help, --print-config or --check-config, or for an error that
/// has been printed.
std::optional<int> ReadCommandLine(int argc, char** argv, Config& config);

}  // namespace footing::footing_sim
