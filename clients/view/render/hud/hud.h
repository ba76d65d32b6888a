#pragma once

#include <cstdint>

#include "clients/view/render/hud/paint.h"
#include "clients/view/scene/model.h"
#include "clients/view/scene/stage.h"

namespace footing::render {

/// What the user has switched on.
struct HudOptions {
  bool hidden = false;  ///< Subject mode: the world alone.
  bool keys = false;
  bool phases = true;
  bool forces = false;
  bool overlay_reference = false;
  bool frozen = false;
  bool replay_asked = false;  ///< Key presses not yet carried out.
  bool t_pose_asked = false;
  bool next_subject_asked = false;
};

/// All panels over the picture.
void DrawHud(const Paint& paint, const scene::Picture& picture, const scene::Model& model,
             const scene::WorldFrame& frame, std::int64_t now_ns, const HudOptions& options,
             ImVec2 size);

}  // namespace footing::render
