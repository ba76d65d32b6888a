#include "daemon/simulation/biped/spot.h"

#include <cmath>

#include "daemon/simulation/biped/ground.h"
#include "daemon/simulation/biped/track.h"

namespace footing::terrain {
namespace {

/// The edge between two segments, one after the other; without distance where there is none.
Edge Between(const stream::TrackSegment& near, const stream::TrackSegment& far) {
  Edge edge;
  const double end_m = near.start_m.z() + near.length_m * std::sin(near.slope_rad);
  edge.rise_m = far.start_m.z() - end_m;
  edge.pit = near.pit || far.pit;
  return edge;
}

bool IsEdge(const Edge& edge) { return edge.pit || std::fabs(edge.rise_m) > kLowestEdgeM; }

}  // namespace

Spot Survey(const stream::Track& track, double x_m, double y_m) {
  const TrackPlace place = Locate(track, {x_m, y_m});
  const auto index = static_cast<std::size_t>(place.segment);
  const stream::TrackSegment& here = track.segments[index];
  const double ribbon_m = here.start_m.z() + place.along_m * std::sin(here.slope_rad);
  Spot spot;
  spot.height_m = here.pit ? ribbon_m - kPitDepthM : ribbon_m;
  spot.slope = std::tan(here.slope_rad);
  spot.heading_rad = here.heading_rad;
  spot.pit = here.pit;
  const double level = std::cos(here.slope_rad);
  if (index > 0) {
    Edge edge = Between(track.segments[index - 1], here);
    edge.distance_m = place.along_m * level;
    if (IsEdge(edge)) spot.behind = edge;
  }
  if (index + 1 < track.segments.size()) {
    Edge edge = Between(here, track.segments[index + 1]);
    edge.distance_m = (here.length_m - place.along_m) * level;
    if (IsEdge(edge)) spot.ahead = edge;
  }
  return spot;
}

}  // namespace footing::terrain
