#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <boost/asio/ip/udp.hpp>
#include <nlohmann/json.hpp>

#include "clients/skeleton/tracking/dialects.h"
#include "clients/skeleton/tracking/synthetic_clip.h"
#include "clients/skeleton/tracking/tracker.h"
#include "common/base/result.h"

namespace footing::skeleton {

/// Options of a sender that plays a clip.
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

/// Resources and packets of a run, beside the tracker's counts.
struct Cost {
  double seconds = 0;
  double cpu_s = 0;
  std::uint64_t dropped_packets = 0;
  std::uint64_t published = 0;  ///< Skeletons, to footingd.
  std::uint64_t hand_frames = 0, dropped_hand_frames = 0;
};

/// The statistics of a run: docs/skeleton.md lists the fields.
nlohmann::ordered_json ToJson(const Tracker& tracker, const Cost& cost);

/// Statistics as a few lines of text.
std::string ToText(const nlohmann::ordered_json& statistics);

}  // namespace footing::skeleton
