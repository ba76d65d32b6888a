#include "common/body/piece.h"

namespace footing::track {

stream::TrackSegment Placed(const Piece& piece, const stream::TrackSegment& last) {
  stream::TrackSegment placed = stream::Following(last);
  placed.length_m = piece.length_m;
  placed.width_m = last.width_m;
  placed.slope_rad = piece.slope_rad;
  placed.heading_rad += piece.curve_rad;
  placed.start_m.z() += piece.step_m;
  placed.pit = piece.pit;
  return placed;
}

}  // namespace footing::track
