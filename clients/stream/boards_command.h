#pragma once

#include <CLI/CLI.hpp>

#include "clients/stream/boards.h"
#include "clients/stream/insoles.h"

namespace footing::stream_client {

/// The subcommand boards and its flags. `options` must outlive the parsing.
CLI::App* AddBoardsCommand(CLI::App& app, BoardsOptions& options);
/// The same of insoles.
CLI::App* AddInsolesCommand(CLI::App& app, InsolesOptions& options);

}  // namespace footing::stream_client
