#pragma once

#include <functional>
#include <string>
#include <vector>

#include "daemon/sensor/service/config.h"

namespace footing::sensor {

/// `before` with those settings of `wanted` that footingd takes while it runs. `say` gets a line
/// with what changed, and one with what needs a restart.
///
/// `changed_files`: settings whose files have another content. The limits of sessions hold for
/// sessions that come; stale_after_s, the token files and clients_file hold at once; default_rig,
/// motion_plus, camera and status_interval_s for devices that attach.
Config Reloaded(const Config& before, const Config& wanted,
                const std::vector<std::string>& changed_files,
                const std::function<void(const std::string& line)>& say);

}  // namespace footing::sensor
