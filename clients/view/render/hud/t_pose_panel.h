#pragma once

#include "clients/view/render/hud/paint.h"
#include "clients/view/scene/model.h"

namespace footing::render {

/// The T-pose wizard: what to do in words, a ring that fills in five seconds. Once the pose is
/// taken only what is wrong is told.
void DrawTPosePanel(const Paint& paint, const scene::Model& model, const scene::CharacterPose& pose,
                    ImVec2 size);

}  // namespace footing::render
