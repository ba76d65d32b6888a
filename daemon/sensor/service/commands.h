#pragma once

#include <cstdint>

#include "daemon/sensor/service/config.h"
#include "daemon/sensor/service/hub.h"
#include "footing/v1/command.pb.h"

namespace footing::sensor {

/// Carries out one command of a session that may give commands, and says how that went.
v1::CommandResult CarryOut(Hub& hub, const Config& config, std::uint64_t session,
                           const v1::Command& command);

}  // namespace footing::sensor
