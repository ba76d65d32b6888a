#pragma once

#include <cstdint>

#include "clients/view/render/hud/paint.h"
#include "clients/view/scene/strip.h"

namespace footing::render {

/// The sensor features of the last 10 s, one controller under the other, at most four. Draws
/// nothing without any.
void DrawStripPanel(const Paint& paint, const Box& box, const scene::StripSet& strips,
                    std::int64_t now_ns);

}  // namespace footing::render
