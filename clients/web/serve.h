#pragma once

#include <CLI/CLI.hpp>

namespace footing::web {

/// Adds the options; what it returns serves until the program is stopped, and returns its exit
/// code.
std::function<int()> AddServe(CLI::App& app);

}  // namespace footing::web
