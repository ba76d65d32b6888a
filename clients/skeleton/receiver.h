#pragma once

#include <optional>
#include <string>

#include <boost/asio/ip/udp.hpp>
#include <nlohmann/json.hpp>

#include "clients/skeleton/tracking/tracker.h"
#include "common/base/result.h"
#include "common/net/address.h"

namespace footing::skeleton {

/// Options of the receiver.
struct ReceiverOptions {
  TrackerOptions tracker;
  boost::asio::ip::udp::endpoint listen;
  std::optional<transport::Address> to;  ///< footingd's device socket; none: nothing is published.
  double seconds = 0;                    ///< Ends by itself after this; 0: by SIGINT or SIGTERM.
  double most_packets_per_s = 50'000;    ///< More are dropped unread.
};

/// Result of a receiver's run.
struct Reception {
  nlohmann::ordered_json statistics;  ///< Output of --json: see docs/skeleton.md.
  Result<void> published;             ///< No device: footingd was not there for all of `seconds`.
};

/// Receives until its end. Failure when it cannot listen.
Result<Reception> RunReceiver(const ReceiverOptions& options);

}  // namespace footing::skeleton
