#pragma once

#include <vector>

#include "common/net/server.h"
#include "footing/v1/session.pb.h"

namespace footing::transport {

/// The channels of a tick, each serialised, as Server::Publish() takes them.
std::vector<ChannelBytes> ChannelsOf(const v1::Tick& tick);

}  // namespace footing::transport
