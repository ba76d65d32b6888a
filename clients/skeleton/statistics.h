#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>

#include "clients/skeleton/tracking/tracker.h"
#include "clients/skeleton/web_server.h"

namespace footing::skeleton {

/// What a run took, beside the tracker's counts.
struct Cost {
  double seconds = 0;
  double cpu_s = 0;
  std::uint64_t dropped_packets = 0;
  std::uint64_t published = 0;  ///< Skeletons, to footingd.
  std::uint64_t hand_frames = 0, dropped_hand_frames = 0;
};

/// The statistics of a run: docs/skeleton.md lists the fields.
nlohmann::ordered_json ToJson(const Tracker& tracker, const Cost& cost);

/// The same of the page.
nlohmann::ordered_json ToJson(const WebCounts& web);

/// The same for a person to read, a few lines.
std::string ToText(const nlohmann::ordered_json& statistics);

}  // namespace footing::skeleton
