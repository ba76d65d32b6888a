#pragma once

#include <cstdint>

#include "common/net/lease_control.h"
#include "daemon/sensor/service/config.h"
#include "daemon/sensor/service/hub.h"
#include "footing/v1/command.pb.h"

namespace footing::sensor {

/// Carries out one command of a session that may give commands, unless another session has the
/// lease, and says how that went.
v1::CommandResult CarryOut(Hub& hub, lease::LeaseControl& lease, const Config& config,
                           std::uint64_t session, const v1::Command& command, std::int64_t now_ns);

}  // namespace footing::sensor
