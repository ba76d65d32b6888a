#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include "common/base/result.h"

namespace footing::log_client {

/// Options and exit code common to all subcommands.
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
void AddAlignCommand(CLI::App& app, Shared& shared);
void AddRecalibrateCommand(CLI::App& app, Shared& shared);
void AddServeCommand(CLI::App& app, Shared& shared);
void AddOscCommand(CLI::App& app, Shared& shared);
void AddServeControlCommand(CLI::App& app, Shared& shared);
void AddLslCommand(CLI::App& app, Shared& shared);

/// Counts of one recalibration, for the summary.
struct RecalibrateReport {
  std::uint64_t messages = 0;   ///< Messages in the whole recording.
  std::uint64_t samples = 0;    ///< Hand samples transformed into W again.
  std::uint64_t untouched = 0;  ///< Hand samples left alone: no tracker frame, or another tracker.
};

/// Copies a recording, with the hands that this tracker saw where another calibration puts them:
/// what it saw in its own frame is in the recording. InvalidData when the recording is cut or has
/// no such hands; `output` is then left as it was.
Result<RecalibrateReport> Recalibrate(const std::string& input, const std::string& output,
                                      const std::string& tracker, const Eigen::Isometry3d& X_WC,
                                      const std::string& library, bool replace);

}  // namespace footing::log_client
