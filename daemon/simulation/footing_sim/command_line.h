#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <boost/asio/io_context.hpp>

#include "common/base/result.h"
#include "common/cli/server.h"
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

/// footing-sim, as its help describes it.
cli::ServerProgram Program();

/// The config of a command line: defaults < file < --set < options of their own. Prints and checks
/// what the command line asks for.
Result<Config> ReadConfig(const cli::ServerLine& line);

/// footing-sim: subscribes to footingd, runs the configured engine on its thread, publishes frames.
/// Reads the engine's files, builds it, opens the listeners and starts. A reload reads the config
/// of `line` again.
Result<cli::RunningServer> StartService(boost::asio::io_context& io, const cli::ServerLine& line,
                                        const Config& config, const std::string& version);

/// `footing-sim export mjcf`, which writes the gait engine's world for MuJoCo and starts no server:
/// its exit code. None where the command line is another one.
std::optional<int> RunExport(int argc, char** argv);

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
