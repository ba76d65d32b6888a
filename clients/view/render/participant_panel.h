#pragma once

#include <cstdint>

#include "clients/view/render/paint.h"
#include "clients/view/scene/model.h"

namespace footing::render {

/// What the participant of a study reads between trials, in the middle of `space`; beside what
/// matters more, at its top, whose height it then takes off `space`. `pose`: the first character;
/// null: there is none.
void DrawParticipantPanel(const Paint& paint, const scene::Model& model,
                          const scene::CharacterPose* pose, std::int64_t now_ns, Box& space);

}  // namespace footing::render
