#pragma once

#include <cstddef>

#include "common/base/units.h"
#include "daemon/offline/pose_run/pose_run.h"

namespace footing::pose_run {

/// Less is not a crouch.
inline constexpr double kCrouchRad = 45 * kPi / 180;

/// A frame, and how far every knee and every hip is bent in it at least: from a straight leg, from
/// a thigh in line with the trunk. A bow leaves the knees straight, a raised knee the other leg.
struct Crouch {
  std::size_t frame = 0;
  double bend_rad = 0;
};

/// Of the true poses, from that frame on, where it bends most with both feet on the ground. Frame
/// `from` where it never bends or stands.
Crouch DeepestCrouch(const PoseRun& run, std::size_t from);

}  // namespace footing::pose_run
