#pragma once

#include "clients/view/render/hud_layout.h"
#include "clients/view/scene/stage.h"

namespace footing::render {

/// The picture's labels beside their points, none over another; one that would stand under a panel
/// is left out.
void DrawLabels(const Paint& paint, const scene::Picture& picture, const HudBoxes& boxes,
                ImVec2 size);

}  // namespace footing::render
