#pragma once

#include <cstdint>

#include "clients/view/render/paint.h"
#include "clients/view/scene/model.h"

namespace footing::render {

/// Centre of pressure, weight and left against right. Draws nothing without a board.
void DrawBoardPanel(const Paint& paint, const Box& box, const scene::Model& model,
                    std::int64_t now_ns);

}  // namespace footing::render
