#pragma once

#include <vector>

#include "common/net/server.h"

/// What footingd publishes in one tick with five devices: three Wiimotes and two Balance Boards at
/// about 100 reports a second, so one sample and one raw report each, and their features.
namespace footing::bench {

std::vector<transport::Channel> SensorChannels();
std::vector<transport::ChannelBytes> ExampleTick();

/// A server for this benchmark: no client is cut because it does not answer.
transport::ServerOptions ServerOptionsFor(double tick_rate_hz, double ring_s);

}  // namespace footing::bench
