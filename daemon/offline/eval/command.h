#pragma once

#include <CLI/CLI.hpp>

namespace footing::eval {

/// What all subcommands share.
struct Shared {
  bool json = false;
  int exit_code = 0;  ///< Set by the subcommand that ran.
};

/// Each adds one subcommand to footing-eval; its callback does the work and sets
/// `shared.exit_code`.
}  // namespace footing::eval
