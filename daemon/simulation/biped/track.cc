#include "daemon/simulation/biped/track.h"

#include <algorithm>
#include <cmath>

namespace footing::terrain {

bool Grows(const stream::Track& track) { return track.extendable || track.endless; }

bool IsFlat(const stream::Track& track) {
  return std::all_of(track.segments.begin(), track.segments.end(), [](const auto& segment) {
    return !segment.pit && segment.slope_rad == 0 && segment.start_m.z() == 0;
  });
}

stream::Track WithPitsFilled(stream::Track track) {
  for (stream::TrackSegment& segment : track.segments) segment.pit = false;
  return track;
}

}  // namespace footing::terrain
