#pragma once

#include <cstdint>

#include "clients/view/render/hud_layout.h"
#include "clients/view/scene/model.h"

namespace footing::render {

PanelHeight DevicePanelHeight(const scene::Model& model);

/// Connections, age of the data, the last response by stage, and every device's health. In a low
/// box without the response, then with one line a device, then with fewer devices.
void DrawDevicePanel(const Paint& paint, const Box& box, const scene::Model& model,
                     std::int64_t now_ns);

}  // namespace footing::render
