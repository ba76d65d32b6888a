#pragma once

#include <functional>
#include <string>
#include <vector>

#include "daemon/simulation/footing_sim/config.h"

namespace footing::footing_sim {

/// `before` with those settings of `wanted` that footing-sim takes while it runs: the limits of
/// sessions, for those that come, and the token files and clients_file, for all. `changed_files`:
/// settings whose files have another content. `say` gets a line with what changed, and one with
/// what needs a restart.
Config Reloaded(const Config& before, const Config& wanted,
                const std::vector<std::string>& changed_files,
                const std::function<void(const std::string& line)>& say);

}  // namespace footing::footing_sim
