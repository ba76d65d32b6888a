#pragma once

#include <string>

#include "common/stream/character.h"
#include "common/stream/gait.h"

namespace footing::stream {

/// A segment without length that begins where another ends and goes on as it does, level.
TrackSegment Following(const TrackSegment& last);

/// "walk to the line, then run".
std::string InstructionFor(Gait before, Gait after);

}  // namespace footing::stream
