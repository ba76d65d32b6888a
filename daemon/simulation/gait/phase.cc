#include "daemon/simulation/gait/phase.h"

#include "common/result/result.h"

namespace footing::gait {

const char* Name(WalkingPhase phase) {
  switch (phase) {
    case WalkingPhase::kDoubleSupport:
      return "double support";
    case WalkingPhase::kRise:
      return "rise";
    case WalkingPhase::kFall:
      return "fall";
  }
  FOOTING_CHECK(false);
}

const char* Name(RunningPhase phase) {
  switch (phase) {
    case RunningPhase::kUpwardFlight:
      return "upward flight";
    case RunningPhase::kDownwardFlight:
      return "downward flight";
    case RunningPhase::kCompression:
      return "compression";
    case RunningPhase::kExtension:
      return "extension";
  }
  FOOTING_CHECK(false);
}

WalkingPhase Next(WalkingPhase phase, const WalkingCues& cues) {
  switch (phase) {
    case WalkingPhase::kDoubleSupport:
      return cues.double_support_over ? WalkingPhase::kRise : phase;
    case WalkingPhase::kRise:
      return cues.half_swing_over ? WalkingPhase::kFall : phase;
    case WalkingPhase::kFall:
      return cues.swing_foot_landed ? WalkingPhase::kDoubleSupport : phase;
  }
  FOOTING_CHECK(false);
}

RunningPhase Next(RunningPhase phase, const RunningCues& cues) {
  switch (phase) {
    case RunningPhase::kUpwardFlight:
      if (cues.landed_early) return RunningPhase::kCompression;
      return cues.falling ? RunningPhase::kDownwardFlight : phase;
    case RunningPhase::kDownwardFlight:
      return cues.landed ? RunningPhase::kCompression : phase;
    case RunningPhase::kCompression:
      return cues.leg_shortest ? RunningPhase::kExtension : phase;
    case RunningPhase::kExtension:
      return cues.lifted_off ? RunningPhase::kUpwardFlight : phase;
  }
  FOOTING_CHECK(false);
}

}  // namespace footing::gait
