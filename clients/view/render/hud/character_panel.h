#pragma once

#include <cstdint>

#include "clients/view/render/hud/paint.h"
#include "clients/view/scene/model.h"

namespace footing::render {

/// Gait, speed against command, turn, pending command, distance, falls, and the strip of the gait
/// controller's states. Returns the panel's lower edge.
float DrawCharacterPanel(const Paint& paint, ImVec2 at, const scene::Model& model,
                         const scene::CharacterPose& pose, bool phases, std::int64_t now_ns);

}  // namespace footing::render
