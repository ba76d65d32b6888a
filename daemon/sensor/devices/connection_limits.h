#pragma once

#include <sys/types.h>

#include <cstdint>
#include <string>

#include "common/net/framed_connection.h"
#include "common/net/peer.h"

namespace footing::devices {

inline constexpr std::uint32_t kMaxEnvelopeBytes = 2048;

/// What one connection may send, and what may wait for it.
transport::FramedLimits LimitsOfOne();

/// How many connections the device socket has at once: settings of footingd. The server's own user
/// and root have places of their own beyond `max_connections`.
struct ConnectionLimits {
  std::int64_t max_connections = 64;
  /// Of one user; all connections over TCP count as one user's.
  std::int64_t max_connections_per_user = 16;
};

/// The connections that there are, those being refused not counted.
struct ConnectionCounts {
  std::int64_t all = 0;
  std::int64_t of_user = 0;  ///< Of the user that comes now.

  void Add(const transport::Peer& there, const transport::Peer& comes);
};

/// Why one more connection of this peer is refused; empty when it is taken.
std::string WhyNoConnection(const ConnectionLimits& limits, const transport::Peer& peer,
                            uid_t own_user, const ConnectionCounts& taken);

}  // namespace footing::devices
