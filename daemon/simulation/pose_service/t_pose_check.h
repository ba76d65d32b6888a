#pragma once

#include <array>

#include "common/body/body.h"
#include "daemon/simulation/reconstruction/reconstruction.h"

namespace footing::pose_service {

/// Where a subject's fists are in the T-pose.
struct TPoseHands {
  double height_m = 0;  ///< Over the ground.
  double span_m = 0;    ///< From one to the other.
};

/// Allocates.
TPoseHands TPoseHandsOf(const body::Body& body);

/// Which tracked hands, left and right, cannot be those of a T-pose: more than 18 % of its height
/// above or below, or both together less than 70 % of its span apart. The margins allow for a
/// subject whose height is not known. A hand that is not tracked, or only to 10 cm, is not checked.
std::array<bool, reconstruction::kHands> HandsOffTPose(
    const TPoseHands& expected,
    const std::array<reconstruction::HandInput, reconstruction::kHands>& hands);

}  // namespace footing::pose_service
