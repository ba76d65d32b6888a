#pragma once

#include <Eigen/Core>

#include "common/stream/track.h"

/// Geometry of a track's centre line, for servers and for whoever looks at a published track.
/// World frame W, SI units.
namespace footing::track {

/// Where a point is relative to the track's centre line.
struct TrackPlace {
  int segment = 0;
  double along_m = 0;     ///< From the segment's start, clamped to its length.
  double sideways_m = 0;  ///< From the centre line, left positive.
  double distance_m = 0;  ///< From the nearest point of the centre line.
};

/// The nearest segment's place; of two equally near the earlier one.
TrackPlace Locate(const stream::Track& track, const Eigen::Vector2d& p_W_m);

/// True beside the ribbon, or beyond its ends.
bool IsOffRibbon(const stream::Track& track, const TrackPlace& place);

/// Length of the centre line from the track's start to a place, and to its end, m. Segments that
/// were dropped count (Track::first_m).
double LengthTo(const stream::Track& track, const TrackPlace& place);
double LengthOf(const stream::Track& track);

/// The place on the centre line at that length, at most at its ends.
TrackPlace PlaceAt(const stream::Track& track, double length_m);

/// A point of the centre line with its heading.
struct CentrePoint {
  Eigen::Vector3d p_W_m = Eigen::Vector3d::Zero();
  double heading_rad = 0;
};

/// The centre line `back_m` before a place: never in a pit nor within 0.5 m of its edge (then
/// before it), never before the start.
CentrePoint CentreBehind(const stream::Track& track, const TrackPlace& place, double back_m);

/// The centre line `ahead_m` after a place, pits included, at most its end.
CentrePoint CentreAhead(const stream::Track& track, const TrackPlace& place, double ahead_m);

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
