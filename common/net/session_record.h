#pragma once

#include <cstdint>
#include <string>

#include "common/net/clock_offset.h"
#include "footing/v1/session.pb.h"

namespace footing::transport {

/// What a session counts and measures of itself. A plain value.
struct SessionRecord {
  /// The server's own ping, once a second: it shows that the client lives, and its clock.
  struct OwnPing {
    std::uint64_t id = 0;
    std::int64_t sent_ns = 0;
    bool unanswered = false;
  };

  std::int64_t began_ns = 0;
  std::uint64_t slowed = 0;          ///< Times that it had to wait for its budget.
  std::int64_t slowed_until_ns = 0;  ///< The end of the last of these times; 0: it never had to.
  std::uint64_t ticks_sent = 0;      ///< Handed to the socket.
  std::uint64_t ticks_dropped = 0;   ///< Of queues of earlier subscriptions.
  std::string drain_reason;          ///< The reason for which it is drained; empty: it is not.
  OwnPing ping;
  ClockOffsetEstimator clock;  ///< Of the client's clock.

  /// The answer to `ping`; any other one says only that the client lives. Stamps without sense, as
  /// those of a client that sends none, are ignored.
  void TakePong(const v1::Pong& pong, std::int64_t arrived_ns);
};

}  // namespace footing::transport
