#pragma once

#include <functional>
#include <string>

#include "daemon/simulation/footing_sim/config.h"

namespace footing::footing_sim {

/// `before` with those settings of `wanted` that footing-sim takes while it runs: the limits of
/// sessions, for those that come. `say` gets a line with what changed, and one with what needs a
/// restart.
Config Reloaded(const Config& before, const Config& wanted,
                const std::function<void(const std::string& line)>& say);

}  // namespace footing::footing_sim
