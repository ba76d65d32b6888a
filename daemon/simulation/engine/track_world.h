#pragma once

#include <memory>
#include <vector>

#include "common/base/result.h"
#include "common/stream/character.h"
#include "daemon/simulation/biped/parameters.h"
#include "daemon/simulation/biped/world.h"
#include "daemon/simulation/biped/ground.h"

namespace footing::engine {

/// A track and the physics over it, as a GaitEngine runs on them.
struct TrackWorld {
  stream::Track track;
  /// The track as the gait controllers see it: without its pits where it does not help over them.
  stream::Track sight;
  bool sees_ground = false;                          ///< That has slopes, steps or pits.
  std::vector<stream::TrackSegment> first_segments;  ///< Of a track that grows: the file's.
  terrain::GroundWindow window;                      ///< Boxes that follow the character.
  physics::World world;
};

/// Builds the physics of a track. Allocates, and takes some milliseconds: not for the simulation
/// thread. Fails when the physics engine does not accept it.
Result<std::unique_ptr<TrackWorld>> MakeTrackWorld(stream::Track track,
                                                   const biped::BipedParameters& biped,
                                                   double step_s);

}  // namespace footing::engine
