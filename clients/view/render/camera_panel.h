#pragma once

#include "clients/view/render/hud_layout.h"
#include "clients/view/scene/camera_preview.h"

namespace footing::render {

/// Nothing where the preview is not asked for.
PanelHeight CameraPanelHeight(const scene::CameraPreview& preview);

/// The camera's picture with what was found in it, how old it is, and a line for each sphere. A
/// picture that is not live is dark, with the reason over it.
void DrawCameraPanel(const Paint& paint, const Box& box, const scene::CameraPreview& preview,
                     std::int64_t now_ns);

}  // namespace footing::render
