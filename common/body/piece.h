#pragma once

#include "common/stream/track.h"

namespace footing::track {

/// Ground to add at a track's end, as a builder thinks of it.
struct Piece {
  double length_m = 2;
  double slope_rad = 0;  ///< Up positive.
  double curve_rad = 0;  ///< Left positive, at its start.
  double step_m = 0;     ///< Up positive, at its start.
  bool pit = false;

  friend bool operator==(const Piece&, const Piece&) = default;
};

/// Where the piece lies behind the last segment, as wide as that.
stream::TrackSegment Placed(const Piece& piece, const stream::TrackSegment& last);

}  // namespace footing::track
