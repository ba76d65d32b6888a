#pragma once

#include "clients/view/render/hud/paint.h"
#include "clients/view/scene/stage.h"

namespace footing::render {

/// The picture's words beside their points, none over another.
void DrawLabels(const Paint& paint, const scene::Picture& picture, ImVec2 size);

}  // namespace footing::render
