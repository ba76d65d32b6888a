#pragma once

#include "clients/view/render/hud/hud.h"

namespace footing::render {

/// What the viewer waits for and how to start it; shown until something comes.
void DrawWaiting(const Paint& paint, const scene::Model& model, ImVec2 size);
/// One small line for each connection that is not live; `at` is the lower left corner.
void DrawWaitingLines(const Paint& paint, const scene::Model& model, ImVec2 at);
/// The list of keys.
void DrawKeys(const Paint& paint, ImVec2 size);
/// "SIMULATED" in the top middle.
void DrawSimulated(const Paint& paint, ImVec2 size);
/// Which moment of the last fall is shown again; nothing while none is.
void DrawReplay(const Paint& paint, const scene::Model& model, std::int64_t now_ns, ImVec2 size);
/// The last event, fading after 3 s.
void DrawNote(const Paint& paint, const scene::Model& model, std::int64_t now_ns, ImVec2 size);

}  // namespace footing::render
