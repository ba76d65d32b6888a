#pragma once

#include <optional>

#include "common/base/result.h"
#include "daemon/simulation/footing_sim/config.h"

namespace footing::footing_sim {

struct CommandLine {
  Config config;
  bool json = false;  ///< Print the listening addresses as one JSON object.
};

/// Reads the command line and the config file into `line` and starts the log. The exit code when
/// the program should end now: after --help, --print-config or --check-config, or for an error that
/// has been printed.
std::optional<int> ReadCommandLine(int argc, char** argv, CommandLine& line);

/// The config of the same command line once more, with what its file has now.
Result<Config> ReadConfigAgain(int argc, char** argv);

}  // namespace footing::footing_sim
