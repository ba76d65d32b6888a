#pragma once

#include <array>
#include <cstddef>

#include "common/body/body.h"
#include "common/body/kinematics.h"
#include "common/stream/hands.h"

namespace footing::body {

/// Place of a joint, not kUnspecified, in an array of all of them.
constexpr std::size_t IndexOf(stream::BodyJoint joint) {
  return static_cast<std::size_t>(joint) - 1;
}

/// Where on the body the joints of a tracked skeleton are, by IndexOf. The head is halfway
/// from the base of the skull to its top, the torso halfway from the hips to the shoulders, fixed
/// to the trunk's nearest joint; the others are landmarks.
std::array<Point, stream::kBodyJoints> SkeletonPoints(const Body& body);

/// The point fixed to the head that is so far above its middle in the T-pose.
Point AboveHead(const Body& body, double above_m);

}  // namespace footing::body
