#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "common/net/server.h"

/// Where the messages of one server of one site go in NATS and MQTT. A message is an Envelope of
/// our protocol, as it is within a frame.
namespace footing::relay {

/// footing.SITE.SERVER.tick: every tick of the server.
std::string TickSubject(const std::string& site, const std::string& server);
/// footing.SITE.SERVER.ask: a Hello is answered by a Welcome and a snapshot, a Ping by a Pong.
std::string AskSubject(const std::string& site, const std::string& server);
/// footing/SITE/SERVER/CHANNEL: the ticks of one channel.
std::string ChannelTopic(const std::string& site, const std::string& server,
                         const std::string& channel);

/// One tick of these channels.
std::string TickMessage(std::uint64_t epoch, const transport::TickNumber& number,
                        const std::vector<transport::ChannelBytes>& channels);

}  // namespace footing::relay
