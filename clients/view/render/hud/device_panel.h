#pragma once

#include <cstdint>

#include "clients/view/render/hud/paint.h"
#include "clients/view/scene/model.h"

namespace footing::render {

/// Connections, age of the data, the last response by stage, and every device's health. `at` is the
/// panel's upper right corner.
void DrawDevicePanel(const Paint& paint, ImVec2 at, const scene::Model& model, std::int64_t now_ns);

}  // namespace footing::render
