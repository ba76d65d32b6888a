#pragma once

#include "common/stream/character.h"

namespace footing::gait {

/// States of the walking and stepping controllers (Figure 5), for each supporting leg.
enum class WalkingPhase { kDoubleSupport, kRise, kFall };

/// States of the running controller (Figure 6); jumping uses one copy of it for both legs.
enum class RunningPhase { kUpwardFlight, kDownwardFlight, kCompression, kExtension };

/// The figures' words: "double support", "rise", ...
const char* Name(WalkingPhase phase);
const char* Name(RunningPhase phase);

/// What the walking machine asks of the state.
struct WalkingCues {
  bool double_support_over = false;  ///< The rear leg is unloaded; it may be picked up.
  bool half_swing_over = false;
  bool swing_foot_landed = false;
};

/// What the running machine asks of the state. In jumping the two legs are one virtual leg.
struct RunningCues {
  bool falling = false;       ///< The COM moves down.
  bool landed_early = false;  ///< A foot touches, long after lift-off, still moving up.
  bool landed = false;
  bool leg_shortest = false;  ///< The stance leg has stopped shortening.
  bool lifted_off = false;    ///< The thrust is over or the feet have left the ground.
};

/// The arrows of Figure 5.
WalkingPhase Next(WalkingPhase phase, const WalkingCues& cues);
/// The arrows of Figure 6.
RunningPhase Next(RunningPhase phase, const RunningCues& cues);

constexpr bool IsHopping(stream::Gait gait) {
  return gait == stream::Gait::kRun || gait == stream::Gait::kJump;
}

}  // namespace footing::gait
