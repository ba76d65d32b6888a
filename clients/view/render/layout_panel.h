#pragma once

#include "clients/view/render/paint.h"
#include "clients/view/scene/model.h"

namespace footing::render {

/// Both boards from above, where they lie, forward up: the load of each cell, the COP of each foot
/// and of both, the trace of the last seconds, and the COM.
void DrawLayoutPanel(const Paint& paint, const Box& box, const scene::Model& model,
                     const scene::CharacterPose& pose, std::int64_t now_ns);

}  // namespace footing::render
