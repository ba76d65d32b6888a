#pragma once

#include "clients/view/render/paint.h"
#include "clients/view/scene/calibration.h"

namespace footing::render {

/// What to do now, how far the rest on the mark is, and in the end the result or the refusal, at
/// the bottom of `space`.
void DrawCalibrationPanel(const Paint& paint, const scene::Calibration& calibration,
                          const Box& space);

}  // namespace footing::render
