#pragma once

#include <cstdint>

#include "clients/view/render/hud/paint.h"
#include "clients/view/scene/model.h"

namespace footing::render {

/// What the user has switched on.
struct HudOptions {
  bool hidden = false;  ///< Subject mode: the world alone.
  bool keys = false;
  bool phases = true;
  bool forces = false;
  bool frozen = false;
  bool replay_asked = false;  ///< A key press not yet carried out.
};

/// All panels over the picture.
void DrawHud(const Paint& paint, const scene::Model& model, const scene::WorldFrame& frame,
             std::int64_t now_ns, const HudOptions& options, ImVec2 size);

}  // namespace footing::render
