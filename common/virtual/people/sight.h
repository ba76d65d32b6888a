#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "common/stream/gait.h"
#include "common/stream/trial.h"

namespace footing::users {

/// What a person in front of the screen sees of the character and the trial, as published.
struct Observation {
  double time_s = 0;
  Eigen::Vector2d p_W_m = Eigen::Vector2d::Zero();
  double com_m = 0;  ///< Height of the COM.
  double heading_rad = 0;
  double speed_mps = 0;
  std::uint64_t steps = 0;
  std::uint64_t falls = 0;
  stream::Gait gait = stream::Gait::kStep;
  stream::TrialProgress trial;
};

/// What the user wants of the character.
struct Intention {
  stream::Gait gait = stream::Gait::kStep;
  double speed_mps = 0;
  double height_m = 0;  ///< Of a jump.
  double turn_rad = 0;  ///< A step, left positive.
  /// How fast to move, for its gait: 0 as slowly as is comfortable, 1 as fast. From the speed
  /// wanted and, since the person sees the result, the speed seen.
  double effort = 0;
  double size = 1;  ///< Of the motion, as a share of the user's own.
};

}  // namespace footing::users
