#pragma once

#include "clients/view/render/paint.h"
#include "clients/view/scene/model.h"

namespace footing::render {

/// At the top of `space`, which it shortens: the task, which the person at the controls must see
/// before the mark, and unless `task_alone` the trial's state, time, way to the finish line and
/// failed attempts. Draws nothing for a character without a trial to show.
void DrawTrialPanel(const Paint& paint, const scene::Model& model, const scene::CharacterPose& pose,
                    bool task_alone, Box& space);

}  // namespace footing::render
