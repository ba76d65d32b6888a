#pragma once

#include <cstdint>

#include "common/body/body.h"
#include "common/virtual/motion/motion.h"
#include "daemon/offline/learning/time_alignment.h"

namespace footing::learning {

/// Somebody who stands in a T-pose, stomps three times, squats and leans
/// (common/virtual/people): the motion as a camera would have it, and what two boards and two
/// hand trackers told of it.
struct MadeTake {
  body::Body body;
  motion::Motion motion;  ///< From its T-pose on, anywhere on the floor.
  RecordedSession session;
};

struct MadeTakeSettings {
  double offset_s = 1.5;  ///< The recording begins so long before the motion; it stands still then.
  double drift = 0;       ///< Drift of the recording's clock.
  double yaw_rad = 0.4;   ///< The cameras' floor is turned against the boards'.
  bool stomps = true;
  bool hands = true;
  std::uint64_t seed = 1;
};

inline constexpr double kMadeMassKg = 70;

/// Boards report every 8 to 14 ms with stamps that are off by 1.5 ms and 0.05 kg of noise.
MadeTake MakeTake(const MadeTakeSettings& settings);

}  // namespace footing::learning
