#pragma once

#include <CLI/CLI.hpp>

namespace footing::skeleton {

/// Options and exit code common to both subcommands.
struct Shared {
  bool json = false;
  int exit_code = 0;
};

/// The options of the receiver, which runs where no subcommand is named. The result is to be
/// called after parsing then.
std::function<void()> AddReceiver(CLI::App& app, Shared& shared);
/// footing-skeleton send: plays a recording or a synthetic person as OSC.
void AddSend(CLI::App& app, Shared& shared);

}  // namespace footing::skeleton
