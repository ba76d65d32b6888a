#pragma once

#include <string>

#include "common/stream/character.h"
#include "daemon/simulation/terrain/track.h"

namespace footing::terrain {

/// How far below the track a pit's floor counts as, for height queries.
inline constexpr double kPitDepthM = 2.0;

/// True when the track is one level without steps and pits: its ground is the endless plane z = 0,
/// on which a character may also leave the ribbon.
bool IsLevel(const stream::Track& track);

/// Height of the ribbon at a place on a segment, as if pits were filled, m.
double RibbonHeight(const stream::TrackSegment& segment, const TrackPlace& place);
/// The same at the place nearest to a point.
double RibbonHeight(const stream::Track& track, double x_m, double y_m);

/// Height of the ground under a point, m. Beside the ribbon the height of the nearest place.
double GroundHeight(const stream::Track& track, double x_m, double y_m);

/// The ground as MJCF geoms of the world body: one plane, or a box a segment that is no pit; the
/// first one begins 3 m before its start.
std::string GroundMjcf(const stream::Track& track);

}  // namespace footing::terrain
