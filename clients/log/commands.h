#pragma once

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "common/base/result.h"

namespace footing::log_client {

/// What all subcommands share.
struct Shared {
  bool json = false;
  int exit_code = 0;  ///< Set by the subcommand that ran.
};

/// Prints a command's answer as the flags ask for, or its error; keeps the exit code.
void Finish(const Result<nlohmann::ordered_json>& result, Shared& shared);

/// Each adds one subcommand to footing-log; its callback does the work.
void AddRecordCommand(CLI::App& app, Shared& shared);
void AddInfoCommand(CLI::App& app, Shared& shared);
void AddExportCommand(CLI::App& app, Shared& shared);
void AddRepairCommand(CLI::App& app, Shared& shared);
void AddRecalibrateCommand(CLI::App& app, Shared& shared);
void AddServeCommand(CLI::App& app, Shared& shared);

}  // namespace footing::log_client
