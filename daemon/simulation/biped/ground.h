#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "common/stream/character.h"
#include "daemon/simulation/biped/track.h"

namespace footing::terrain {

/// Properties of the ground for a foot, the same all over a world.
struct Surface {
  double friction = 0;  ///< Sliding friction; 0: the biped's own.
  double sinks_m = 0;   ///< How far one foot sinks under the whole weight; 0: hard ground.
};

/// A segment's ground as a solid box.
struct GroundBox {
  Eigen::Vector3d centre_W_m = Eigen::Vector3d::Zero();
  Eigen::Quaterniond q_WS = Eigen::Quaterniond::Identity();
  Eigen::Vector3d half_size_m = Eigen::Vector3d::Zero();
};

/// The box under a segment; its top face is the ground. Where the track turns, two boxes would
/// leave a wedge open on the outer side: one of them reaches under the other to close it, the lower
/// one, so that a step begins where the track has it. A pit's edges stay where they are. The first
/// segment has no `previous` and begins before the start, so that one can stand on the line; the
/// last one has no `next`.
GroundBox BoxOf(const stream::TrackSegment* previous, const stream::TrackSegment& segment,
                const stream::TrackSegment* next);
/// The same by its place in the track.
GroundBox BoxOf(const stream::Track& track, std::size_t index);

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
/// Name of the geom of a box, for MuJoCo.
std::string GroundBoxName(int index);

/// The ground in MJCF.
struct GroundText {
  std::string mjcf;
  std::vector<std::string> names;  ///< Names of its geoms, in their order.
};
/// The ground as MJCF geoms of the world body: the waiting ones of WindowOf, else one plane
/// (HasPlane), or a box for each segment that is not a pit; the first one begins 3 m before its
/// start.
GroundText GroundMjcf(const stream::Track& track);
/// The same for a world that nobody moves boxes in: those of WindowOf are at their places, too, a
/// box for each segment.
GroundText WholeGroundMjcf(const stream::Track& track);

/// Where the ground's height changes at once, across the track.
struct Edge {
  double distance_m = std::numeric_limits<double>::infinity();  ///< Along the track.
  double rise_m = 0;  ///< From its near to its far side as one goes along the track.
  bool pit = false;   ///< On either side: then the rise is that of the ribbon.
};

/// The ground around a point of a track.
struct Spot {
  double height_m = 0;
  double slope = 0;        ///< Rise over run along the track.
  double heading_rad = 0;  ///< Heading of the track here.
  bool pit = false;        ///< The height is its floor's.
  Edge behind, ahead;      ///< Edges of this segment; infinitely far where the ground goes on.
};

/// Smaller changes of height do not count as edges.
inline constexpr double kLowestEdgeM = 0.01;

/// Looks at one segment and its two neighbours. Beside the ribbon as at the nearest place.
Spot Survey(const stream::Track& track, double x_m, double y_m);

}  // namespace footing::terrain
