#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "daemon/offline/compute/ranks.h"

namespace footing::train {

/// What all subcommands share.
struct Shared {
  bool json = false;
  std::string command_line;  ///< For the model's provenance.
  int exit_code = 0;         ///< Set by the subcommand that ran.
  ranks::Ranks ranks;        ///< Of which this process is one; `people` alone shares its work.
};

/// Each adds one subcommand to footing-train; its callback does the work and sets
/// `shared.exit_code`.
void AddArmCommand(CLI::App& app, Shared& shared);
void AddBasisCommand(CLI::App& app, Shared& shared);
void AddCascadeCommand(CLI::App& app, Shared& shared);
void AddComCommand(CLI::App& app, Shared& shared);
void AddMlpCommand(CLI::App& app, Shared& shared);
void AddPeopleCommand(CLI::App& app, Shared& shared);
void AddPoseCommand(CLI::App& app, Shared& shared);

}  // namespace footing::train
