#pragma once

#include "clients/view/render/paint.h"
#include "clients/view/scene/model.h"

namespace footing::render {

/// The T-pose wizard at the bottom of `space`: what to do, and a ring that fills in five seconds.
/// Once the pose is taken, only what is wrong.
void DrawTPosePanel(const Paint& paint, const scene::Model& model, const scene::CharacterPose& pose,
                    const Box& space);

}  // namespace footing::render
