#pragma once

#include <vector>

#include "clients/view/render/hud.h"
#include "clients/view/scene/live_keys.h"

namespace footing::render {

/// What the viewer waits for and how to start it; shown until something comes.
void DrawWaiting(const Paint& paint, const scene::Model& model, const Box& box);
/// A few small lines for each connection that is not live, from the bottom of `space` upwards;
/// takes away from `space` what they fill.
void DrawWaitingLines(const Paint& paint, const scene::Model& model, Box& space);
/// The list of keys, at the right: the figure in the middle stays in sight.
void DrawKeys(const Paint& paint, ImVec2 size, const std::vector<scene::KeyLine>& keys);
/// What is shown of several recordings, and how it stands. A banner as those below.
void DrawTitle(const Paint& paint, const std::string& title, const std::string& over, Box& space);
/// "SIMULATED INPUT" in the middle of a row.
void DrawSimulated(const Paint& paint, const Box& row);
/// Which moment of the last fall is shown again; nothing while none is. This and what follows is a
/// banner from the top of `space`, and takes away from `space` what it fills.
void DrawReplay(const Paint& paint, const scene::Model& model, std::int64_t now_ns, Box& space);
/// The last event, fading after 3 s.
void DrawNote(const Paint& paint, const scene::Model& model, std::int64_t now_ns, Box& space);
/// That the picture is frozen.
void DrawFrozen(const Paint& paint, Box& space);

}  // namespace footing::render
