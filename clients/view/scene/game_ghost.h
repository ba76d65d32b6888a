#pragma once

#include "clients/view/scene/part.h"
#include "common/stream/game.h"

namespace footing::scene {

/// The segment that the terrain game's builder holds, as a slab that one sees through; nothing
/// without one.
void AddGhostSegment(const stream::GameState& game, PartList& ghosts);

}  // namespace footing::scene
