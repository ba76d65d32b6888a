#include "common/stream/track.h"

#include <cmath>

namespace footing::stream {

TrackSegment Following(const TrackSegment& last) {
  TrackSegment next;
  const double level_m = last.length_m * std::cos(last.slope_rad);
  next.start_m = last.start_m + Eigen::Vector3d(level_m * std::cos(last.heading_rad),
                                                level_m * std::sin(last.heading_rad),
                                                last.length_m * std::sin(last.slope_rad));
  next.heading_rad = last.heading_rad;
  return next;
}

}  // namespace footing::stream
