#pragma once

#include <string>
#include <string_view>

#include "common/base/result.h"
#include "common/virtual/motion/markers.h"

/// TRC: marker places as text, a row a frame (Motion Analysis; OpenSim).
namespace footing::motion {

/// Reads one in its own axes (OpenSim's: FileAxes::kYUp). A marker whose three fields are empty,
/// not numbers ("NaN"), or all exactly 0 was not seen in that frame. `file` is the name for errors,
/// which say the line and what was expected there.
Result<MarkerTracks> ParseTrc(std::string_view text, const std::string& file);

/// Writes one in millimetres. What was read from our own output is written again byte for byte.
std::string WriteTrc(const MarkerTracks& tracks, const std::string& name);

}  // namespace footing::motion
