#pragma once

#include <string>

#include "common/result/result.h"
#include "common/stream/character.h"

/// Tracks as data: a ribbon of segments, 4 m wide in the paper (section 8.2).
namespace footing::terrain {

/// Reads a track. The file is one object:
///   version   1
///   name      text; comment   text, ignored
///   width_m   (0, 100], 4 by default
///   open      true: a character may leave the ribbon; otherwise that is a failure
///   extendable  true: segments may be added later (append.h); those of the file are then 1 to 32
///             of at least 2 m
///   endless   true: the track continues itself ahead of the character (endless.h); level
///   help_over_pits  false: the gait controllers do not see pits; a jump's timing is the user's
///   start_m, finish_m  lines across the track, m along it: where a trial's clock starts (1 by
///             default) and stops (5 m before the end; 0, without a finish, on a track that is open
///             or grows)
///   mark      {at_m, within_m, tasks: [{name, before, after}]}: a line at which a trial's task is
///             due: the gait `after`, within 15 m by default; `before` is the gait up to the line
///   segments  1 to 1000 objects {length_m (0, 10000], slope_deg [-30, 30], curve_deg [-90, 90],
///             step_m [-0.5, 0.5], pit true or false, repeat}; all but the length default to
///             nothing, repeat to 1.
/// The track starts at the origin along x. curve_deg turns the heading and step_m raises the
/// ground at the segment's start; positive is left and up. `origin` names the file in errors.
Result<stream::Track> ParseTrack(const std::string& text, const std::string& origin);

/// True when segments are added to the track while a character is on it.
bool Grows(const stream::Track& track);

/// True when no segment has a slope or a pit or begins with a step.
bool IsFlat(const stream::Track& track);

/// The track as it looks to whoever does not see its pits.
stream::Track WithPitsFilled(stream::Track track);

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

}  // namespace footing::terrain
