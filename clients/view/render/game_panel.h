#pragma once

#include "clients/view/render/paint.h"
#include "common/stream/game.h"

namespace footing::render {

/// At the top of `space`, which it shortens: what happens in the terrain game, the time left, both
/// players with their parts and points, and what the builder holds. Draws as much of it as fits.
/// `game` is one to show (scene::ShowsGame).
void DrawGamePanel(const Paint& paint, const stream::GameState& game, Box& space);

}  // namespace footing::render
