#pragma once

#include <cstdint>

#include "clients/view/render/hud_layout.h"
#include "clients/view/scene/strip.h"

namespace footing::render {

PanelHeight StripPanelHeight(const scene::StripSet& strips);

/// The sensor features of the last 10 s, one controller under the other, at most four and as many
/// as the box has space for. The curves stand still while nothing comes.
void DrawStripPanel(const Paint& paint, const Box& box, const scene::StripSet& strips,
                    std::int64_t now_ns);

}  // namespace footing::render
