#pragma once

#include <string>

#include "clients/stream/plan.h"
#include "common/base/result.h"

namespace footing::stream_client {

/// The devices of a recording of footingd, from their first report to their last. InvalidData when
/// it holds no raw report; a device whose handshake was not recorded is named in the log.
Result<Plan> PlanReplay(const std::string& path, const Common& common);

}  // namespace footing::stream_client
