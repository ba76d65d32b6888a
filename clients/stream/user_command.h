#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "clients/stream/live_user.h"

namespace footing::stream_client {

struct UserOptions {
  std::string script = "demo";
  std::string interface = "wrist";
  std::string see;  ///< Address of footing-sim; empty: the user follows the script.
  Ports ports;
};

/// The subcommand user and its flags. `options` must outlive the parsing.
CLI::App* AddUserCommand(CLI::App& app, UserOptions& options);

}  // namespace footing::stream_client
