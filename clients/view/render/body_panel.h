#pragma once

#include "clients/view/render/hud_layout.h"
#include "clients/view/scene/stage.h"

namespace footing::render {

PanelHeight BodyPanelHeight(const scene::CharacterPose& pose, const scene::Picture& picture);

/// Subject, mode, lag, T-pose, resets, feet and hands of a reconstructed body; keys, angular
/// momentum and the legend of the reference only where there is space for them.
void DrawBodyPanel(const Paint& paint, const Box& box, const scene::CharacterPose& pose,
                   const scene::Picture& picture);

}  // namespace footing::render
