#pragma once

#include <string>
#include <vector>

#include "common/stream/character.h"
#include "daemon/simulation/biped/box.h"
#include "daemon/simulation/biped/track.h"

namespace footing::terrain {

/// How far below the track a pit's floor counts as, for height queries.
inline constexpr double kPitDepthM = 2.0;

/// True when the track is level and stays so, without steps and pits.
bool IsLevel(const stream::Track& track);

/// True when a level track's ground is the endless plane z = 0, since a character may leave the
/// ribbon. Beside every other ribbon there is nothing to stand on.
bool HasPlane(const stream::Track& track);

/// Height of the ribbon at a place on a segment, as if pits were filled, m.
double RibbonHeight(const stream::TrackSegment& segment, const TrackPlace& place);
/// The same at the place nearest to a point.
double RibbonHeight(const stream::Track& track, double x_m, double y_m);

/// Height of the ground under a point, m. Beside the ribbon the height of the nearest place.
double GroundHeight(const stream::Track& track, double x_m, double y_m);

/// Boxes of a track's world that stand for the segments near the character, and how many of them
/// are for segments behind its own. A box costs time in every step, also far away.
struct GroundWindow {
  int boxes = 0;  ///< 0: the whole ground stays where it is.
  int behind = 0;
};
inline constexpr int kGroundBoxes = 32;  ///< At most; an extendable track has as many.
/// As many as reach 2.5 m to both sides of any point of the track, if that saves any.
GroundWindow WindowOf(const stream::Track& track);

/// Far below everything: where a box waits that no segment needs.
GroundBox WaitingBox(int index);
std::string GroundBoxName(int index);

struct GroundText {
  std::string mjcf;
  std::vector<std::string> names;  ///< Of its geoms, in their order.
};
/// The ground as MJCF geoms of the world body: the waiting ones of WindowOf, else one plane
/// (HasPlane), or a box for each segment that is not a pit; the first one begins 3 m before its
/// start.
GroundText GroundMjcf(const stream::Track& track);

}  // namespace footing::terrain
