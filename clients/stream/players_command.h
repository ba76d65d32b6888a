#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace footing::stream_client {

/// The terrain game's synthetic players.
struct PlayersOptions {
  std::string simulation;  ///< Address of footing-sim, which the runner sees; empty: the default.
  bool pits = false;       ///< The builder lays pits, too.
};

CLI::App* AddRunnerCommand(CLI::App& app, PlayersOptions& options);
CLI::App* AddBuilderCommand(CLI::App& app, PlayersOptions& options);

}  // namespace footing::stream_client
