#pragma once

#include <cstdint>

#include "clients/view/render/paint.h"
#include "clients/view/scene/model.h"
#include "clients/view/scene/text.h"

namespace footing::render {

/// State of a study's session, for its experimenter; takes its height off `space`.
void DrawStudyPanel(const Paint& paint, const scene::Model& model, std::int64_t now_ns, Box& space);

/// Text for a study's participant between trials, or for players, in the middle of `space`; at its
/// top where the world matters more, and then its height is taken off `space`.
void DrawParticipantPanel(const Paint& paint, const scene::ParticipantText& text, Box& space);

/// Both boards from above, where they lie, forward up: the load of each cell, the COP of each foot
/// and of both, the trace of the last seconds, and the COM.
void DrawLayoutPanel(const Paint& paint, const Box& box, const scene::Model& model,
                     const scene::CharacterPose& pose, std::int64_t now_ns);

}  // namespace footing::render
