#pragma once

#include "common/stream/character.h"
#include "daemon/simulation/biped/parameters.h"

namespace footing::biped {

/// Five links (body, left hip, left knee, right hip, right knee) and the contact points left_foot
/// and right_foot. A link's frame is its own body frame: the body's COM, the hip's centre, the
/// knee link's COM.
stream::Skeleton DescribeSkeleton(const BipedParameters& parameters);

}  // namespace footing::biped
