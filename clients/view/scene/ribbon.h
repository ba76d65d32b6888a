#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "common/stream/character.h"

namespace footing::scene {

/// A corner of the track's surface.
struct RibbonVertex {
  Eigen::Vector3f position;
  Eigen::Vector3f normal;
  float along_m;     ///< From the track's start along its centre line.
  float sideways_m;  ///< From the centre line, left positive.
  float half_width_m;
  float kind;  ///< 0 surface, 1 pit, 2 side, 3 white paint, 4 yellow paint.
};

struct RibbonMesh {
  std::vector<RibbonVertex> vertices;
  std::vector<std::uint32_t> indices;
};

/// The track as triangles: top faces, pits as sunken dark floors, the sides down to the ground,
/// the distance painted on every tenth metre, and the lines of a trial: start, finish, mark and,
/// where a track has tasks, the middle. At most 2000 segments are drawn.
RibbonMesh BuildRibbon(const stream::Track& track);

/// Height of the track under a point; `ground_m` beside it and in pits.
double HeightAt(const stream::Track& track, const Eigen::Vector2d& p_m, double ground_m);

/// Height of the ground around the track: just below its lowest corner; 0 without a track.
double GroundHeight(const stream::Track& track);

}  // namespace footing::scene
