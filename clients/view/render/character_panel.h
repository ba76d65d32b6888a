#pragma once

#include <cstdint>

#include "clients/view/render/hud_layout.h"
#include "clients/view/scene/model.h"

namespace footing::render {

/// With the states of the gait controller only where there is space for them.
PanelHeight CharacterPanelHeight(bool phases);

/// Gait, speed against command, turn, pending command, distance, falls, and the strip of the gait
/// controller's states.
void DrawCharacterPanel(const Paint& paint, const Box& box, const scene::Model& model,
                        const scene::CharacterPose& pose, std::int64_t now_ns);

}  // namespace footing::render
