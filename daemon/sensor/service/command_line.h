#pragma once

#include <optional>

#include "common/base/result.h"
#include "daemon/sensor/service/config.h"

namespace footing::sensor {

/// What the command line asks for.
struct CommandLine {
  Config config;
  bool json = false;  ///< One JSON object on standard output once it listens.
};

/// Parses it and reads the config: defaults < file < --set < flags of their own. Without a value
/// the program ends with `exit_code`: help, version, --print-config, --check-config or an error,
/// already printed.
std::optional<CommandLine> ParseCommandLine(int argc, char** argv, int& exit_code);

/// The config of the same command line once more, with what its file has now.
Result<Config> ReadConfigAgain(int argc, char** argv);

}  // namespace footing::sensor
