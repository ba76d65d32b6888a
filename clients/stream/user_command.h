#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>
#include <string>

#include "clients/stream/live_user.h"

namespace footing::stream_client {

struct UserOptions {
  std::string script = "demo";
  std::string interface = "wrist";
  std::string turn_by = "head";
  std::optional<double> grip_deg;
  std::string grip_way = "mirrored";
  std::string see;  ///< Address of footing-sim; empty: the user follows the script.
  bool ranges = false;
  std::optional<std::uint64_t> style_seed;
  users::StyleWish style;
  Ports ports;
};

/// The subcommand user and its flags. `options` must outlive the parsing.
CLI::App* AddUserCommand(CLI::App& app, UserOptions& options);

}  // namespace footing::stream_client
