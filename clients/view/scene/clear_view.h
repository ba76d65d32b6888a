#pragma once

#include <Eigen/Core>

#include "clients/view/scene/camera.h"
#include "clients/view/scene/stage.h"
#include "common/stream/character.h"

namespace footing::scene {

/// Least height of the eye over the ground: more than twice the distance of the near plane.
inline constexpr double kEyeOverGroundM = 0.35;
/// A figure's reach: a bird with its wings open and in a jump, a person with the arms out.
inline constexpr double kFigureReachM = 1.0, kFigureHeightM = 1.9;

/// The camera after the person's own turn of the view, where neither ground nor figures stand
/// before the eye: raised until the way to the pivot is clear of the track, and put out of the
/// reach of every figure.
Camera ClearView(const Picture& picture, const stream::Track& track, const Orbit& orbit);

}  // namespace footing::scene
