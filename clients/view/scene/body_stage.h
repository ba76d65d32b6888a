#pragma once

#include "clients/view/scene/body_signs.h"
#include "clients/view/scene/model.h"
#include "clients/view/scene/stage.h"

namespace footing::scene {

/// Adds a reconstructed person: the figure, or before its T-pose the silhouette to stand in, the
/// boards, the signs, and the reference beside it or over it.
void AddBody(const Model& model, const CharacterPose& pose, const ComTrail& trail,
             std::int64_t now_ns, const StageOptions& options, Picture& picture);

/// A reference came within the last second.
bool HasReference(const Model& model, std::int64_t now_ns);

}  // namespace footing::scene
