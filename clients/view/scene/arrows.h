#pragma once

#include "clients/view/scene/part.h"
#include "clients/view/scene/update.h"

namespace footing::scene {

/// Arrows at the feet, along the ground's normal force: 1 m long for kForcePerMetreN.
inline constexpr double kForcePerMetreN = 600;

void AddForceArrows(const CharacterPose& pose, PartList& parts);

}  // namespace footing::scene
