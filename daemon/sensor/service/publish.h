#pragma once

#include <vector>

#include "common/net/server.h"
#include "daemon/sensor/service/tick_content.h"

namespace footing::sensor {

/// The channels that footingd publishes; a channel is one field of v1::Tick.
std::vector<transport::Channel> Channels();

/// Each channel that has something to say, serialised once for all sessions.
std::vector<transport::ChannelBytes> ToChannels(const TickContent& content);

}  // namespace footing::sensor
