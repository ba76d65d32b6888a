#pragma once

#include <limits>

#include "common/stream/character.h"

namespace footing::terrain {

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
  double heading_rad = 0;  ///< Of the track here.
  bool pit = false;        ///< The height is its floor's.
  Edge behind, ahead;      ///< Of this segment; infinitely far where the ground goes on.
};

/// Smaller changes of height do not count as edges.
inline constexpr double kLowestEdgeM = 0.01;

/// Looks at one segment and its two neighbours. Beside the ribbon as at the nearest place.
Spot Survey(const stream::Track& track, double x_m, double y_m);

}  // namespace footing::terrain
