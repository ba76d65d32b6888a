#pragma once

#include <boost/asio/io_context.hpp>
#include <string>

#include "common/result/result.h"
#include "daemon/simulation/footing_sim/config.h"
#include "daemon/simulation/serving/serving.h"

namespace footing::footing_sim {

/// footing-sim: subscribes to footingd, runs the configured engine on its thread, publishes frames.
/// Reads the engine's files, builds it, opens the listeners and starts.
Result<serving::Served> StartService(boost::asio::io_context& io, const Config& config,
                                     const std::string& version);

}  // namespace footing::footing_sim
