#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "clients/stream/setup_person.h"

namespace footing::stream_client {

struct RehearseOptions {
  SetupPersonOptions person;
  std::string sensor;  ///< Address of footingd, whose setup is followed; empty: the default.
  bool json = false;
};

/// The subcommand rehearse and its flags. `options` must outlive the parsing.
CLI::App* AddRehearseCommand(CLI::App& app, RehearseOptions& options);

/// Prints what was asked for and performed.
void PrintAsked(const SetupRecord& record, bool json);

}  // namespace footing::stream_client
