#pragma once

#include <CLI/CLI.hpp>

namespace footing::relay {

/// What both ways to run have in common.
struct Shared {
  bool json = false;
  int exit_code = 0;
};

/// Each adds one subcommand to footing-relay; its callback does the work.
void AddPublishCommand(CLI::App& app, Shared& shared);
void AddServeCommand(CLI::App& app, Shared& shared);

}  // namespace footing::relay
