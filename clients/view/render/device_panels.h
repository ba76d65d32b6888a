#pragma once

#include <cstdint>

#include "clients/view/render/hud_layout.h"
#include "clients/view/render/paint.h"
#include "clients/view/scene/camera.h"
#include "clients/view/scene/model.h"
#include "clients/view/scene/update.h"

namespace footing::render {

/// Centre of pressure, weight and left against right. Draws nothing without a board.
void DrawBoardPanel(const Paint& paint, const Box& box, const scene::Model& model,
                    std::int64_t now_ns);

/// Heights that the panel asks for.
PanelHeight DevicePanelHeight(const scene::Model& model);

/// Connections, age of the data, the last response by stage, and every device's health. In a low
/// box without the response, then with one line a device, then with fewer devices.
void DrawDevicePanel(const Paint& paint, const Box& box, const scene::Model& model,
                     std::int64_t now_ns);

/// Nothing where the preview is not asked for.
PanelHeight CameraPanelHeight(const scene::CameraPreview& preview);

/// The camera's picture with what was found in it, how old it is, and a line for each sphere. A
/// picture that is not live is dark, with the reason over it.
void DrawCameraPanel(const Paint& paint, const Box& box, const scene::CameraPreview& preview,
                     std::int64_t now_ns);

/// A large banner that the character's devices are silent, from the top of `space`, and takes away
/// from `space` what it fills; nothing while they are there.
void DrawLostPanel(const Paint& paint, const scene::CharacterPose& pose, Box& space);

}  // namespace footing::render
