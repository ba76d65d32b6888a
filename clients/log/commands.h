#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include "common/base/result.h"
#include "common/net/address.h"

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
void AddRecalibrateCommand(CLI::App& app, Shared& shared);
void AddServeCommand(CLI::App& app, Shared& shared);
void AddOscCommand(CLI::App& app, Shared& shared);

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

/// Options of a recording.
struct RecordOptions {
  std::vector<transport::Address> addresses;
  std::string out;
  double seconds = 0;      ///< From the start; 0: until SIGINT or SIGTERM.
  bool from_ring = false;  ///< First what the servers' rings still hold, up to 30 s.
  bool replace = false;
  bool compress = true;                  ///< Chunks, by zstd.
  std::vector<std::string> attachments;  ///< Files: config, calibrations, track, survey.
  std::string version;
};

/// Counts of a finished recording.
struct RecordReport {
  std::uint64_t messages = 0;
  std::uint64_t ticks = 0;
  std::uint64_t missing_ticks = 0;
  double duration_s = 0;  ///< Between the first and the last message.
};

/// Records until the time is up or SIGINT or SIGTERM comes, then ends the file properly. Progress
/// goes to standard error. A recording into which nothing came is a failure that says what was
/// waited for, and leaves no file, or the existing one as it was; a disk that is full is a failure,
/// and the file stays repairable.
Result<RecordReport> Record(const RecordOptions& options);

}  // namespace footing::log_client
