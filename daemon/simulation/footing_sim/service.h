#pragma once

#include <boost/asio/io_context.hpp>
#include <string>

#include "common/base/result.h"
#include "daemon/simulation/footing_sim/config.h"
#include "daemon/simulation/serving/serving.h"

namespace footing::footing_sim {

/// footing-sim: subscribes to footingd, runs the configured engine on its thread, publishes frames.
/// Reads the engine's files, builds it, opens the listeners and starts.
Result<serving::Served> StartService(boost::asio::io_context& io, const Config& config,
                                     const std::string& version);

/// What StartService checks besides the config itself: reads all files and builds the engine, and
/// opens no socket.
Result<void> CheckService(const Config& config);

}  // namespace footing::footing_sim
