#pragma once

#include <boost/asio/ip/udp.hpp>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "clients/skeleton/tracking/kinect_clip.h"
#include "clients/skeleton/tracking/dialects.h"
#include "common/base/result.h"

namespace footing::skeleton {

struct SenderOptions {
  boost::asio::ip::udp::endpoint to;
  Dialect dialect = Dialect::kFooting;
  DialectOptions dialect_options;
  double rate_scale = 1;    ///< The clip plays this much faster.
  double rate_hz = 0;       ///< Frames a second whatever the clip's times; 0: as it was recorded.
  std::int32_t people = 1;  ///< Each frame is sent for users 1 to this.
  double seconds = 0;       ///< The clip repeats for this time; 0: once.
};

/// Plays a clip as a sender of OSC does, in real time; {seconds, frames, packets, bytes}. Failure
/// when the address cannot be sent to.
Result<nlohmann::ordered_json> SendClip(const std::vector<ClipFrame>& clip,
                                        const SenderOptions& options);

}  // namespace footing::skeleton
