#pragma once

#include <cstdint>

#include "clients/view/render/paint.h"
#include "clients/view/scene/model.h"

namespace footing::render {

/// Where a study's session stands, for its experimenter; takes its height off `space`.
void DrawStudyPanel(const Paint& paint, const scene::Model& model, std::int64_t now_ns, Box& space);

}  // namespace footing::render
