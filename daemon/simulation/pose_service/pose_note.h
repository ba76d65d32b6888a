#pragma once

#include <string>

#include "daemon/simulation/pose_service/pose_frame.h"
#include "daemon/simulation/pose_service/subject_body.h"

namespace footing::pose_service {

/// Further than this from the subject file, the weight on the boards is another person's, or a
/// board needs its tare.
inline constexpr double kMassTolerance = 0.03;

/// Why there is no measurement of the hand of that side ("left").
std::string HandText(HandTrouble trouble, const std::string& side);

/// What is wrong and what to do about it, for a person; empty when all is well.
std::string PoseNote(const PoseFrame& frame, const Subject& subject);

}  // namespace footing::pose_service
