#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "clients/view/scene/course.h"

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
/// where a track has tasks, the middle. At most kMostSegments are drawn. Bends are drawn as curves,
/// at most 1 m to either side of each joint. An endless track goes on for its fade.
RibbonMesh BuildRibbon(const stream::Track& track);

}  // namespace footing::scene
