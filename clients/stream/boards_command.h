#pragma once

#include <CLI/CLI.hpp>

#include "clients/stream/boards.h"

namespace footing::stream_client {

/// The subcommand boards and its flags. `options` must outlive the parsing.
CLI::App* AddBoardsCommand(CLI::App& app, BoardsOptions& options);

}  // namespace footing::stream_client
