#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <boost/asio/io_context.hpp>

#include "common/base/result.h"
#include "daemon/simulation/gait_service/config.h"
#include "daemon/simulation/pose_service/pose_line.h"
#include "daemon/simulation/serving/simulation_thread.h"

namespace footing::footing_sim {

/// All settings of footing-sim. A config file may hold those of both engines.
struct Config {
  std::string engine = "gait";
  serving::Config serving;
  gait_service::Config gait;
  pose_service::Config pose;

  void Bind(config::Binder& binder);
};

/// Usage error that lists what there is when engine, interface, mode or lag is none of them.
Result<void> Check(const Config& config);

/// Usage error when one of `settings` ("key=value"), given on the command line, belongs to the
/// engine that does not run.
Result<void> CheckApply(const Config& config, const std::vector<std::string>& settings);

/// Request on the command line.
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

/// footing-sim: subscribes to footingd, runs the configured engine on its thread, publishes frames.
/// Reads the engine's files, builds it, opens the listeners and starts.
Result<serving::Served> StartService(boost::asio::io_context& io, const Config& config,
                                     const std::string& version);

/// Checks of StartService besides the config itself: reads all files and builds the engine, and
/// opens no socket.
Result<void> CheckService(const Config& config);

/// `before` with those settings of `wanted` that footing-sim takes while it runs: the limits of
/// sessions, for those that come, and the token files and clients_file, for all. `changed_files`:
/// settings whose files have another content. `say` gets a line with what changed, and one with
/// what needs a restart.
Config Reloaded(const Config& before, const Config& wanted,
                const std::vector<std::string>& changed_files,
                const std::function<void(const std::string& line)>& say);

}  // namespace footing::footing_sim
