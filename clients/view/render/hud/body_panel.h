#pragma once

#include "clients/view/render/hud/paint.h"
#include "clients/view/scene/stage.h"

namespace footing::render {

/// Subject, mode, lag, T-pose, resets, feet and hands of a reconstructed body. Returns its lower
/// edge.
float DrawBodyPanel(const Paint& paint, ImVec2 at, const scene::CharacterPose& pose,
                    const scene::Picture& picture);

}  // namespace footing::render
