#include "daemon/simulation/engine/track_world.h"

#include <string>
#include <utility>

#include "daemon/simulation/biped/mjcf.h"
#include "daemon/simulation/biped/append.h"
#include "daemon/simulation/biped/ground.h"
#include "daemon/simulation/biped/track.h"

namespace footing::engine {

Result<std::unique_ptr<TrackWorld>> MakeTrackWorld(stream::Track track,
                                                   const biped::BipedParameters& biped,
                                                   double step_s) {
  std::vector<std::string> boxes;
  const terrain::GroundWindow window = terrain::WindowOf(track);
  for (int i = 0; i < window.boxes; ++i) {
    boxes.push_back(terrain::GroundBoxName(i));
  }
  const terrain::GroundText ground = terrain::GroundMjcf(track);
  Result<physics::World> world = physics::World::FromMjcf(
      biped::WriteMjcf(biped, ground.mjcf, ground.names, step_s), biped::Names(boxes));
  if (!world) return world.error();
  auto made = std::make_unique<TrackWorld>(TrackWorld{.track = std::move(track),
                                                      .sight = {},
                                                      .sees_ground = false,
                                                      .first_segments = {},
                                                      .window = window,
                                                      .world = std::move(*world)});
  if (!made->track.help_over_pits) made->sight = terrain::WithPitsFilled(made->track);
  made->sees_ground = !terrain::IsLevel(made->track.help_over_pits ? made->track : made->sight);
  if (terrain::Grows(made->track)) {
    made->first_segments = made->track.segments;
    made->track.segments.reserve(terrain::kMostSegments);
  }
  return made;
}

}  // namespace footing::engine
