#pragma once

#include "clients/view/render/paint.h"
#include "clients/view/scene/update.h"

namespace footing::render {

/// A large banner that the character's devices are silent, from the top of `space`, and takes away
/// from `space` what it fills; nothing while they are there.
void DrawLostPanel(const Paint& paint, const scene::CharacterPose& pose, Box& space);

}  // namespace footing::render
