#include "daemon/simulation/gait/anticipation.h"

#include <algorithm>

namespace footing::gait {

double AnticipatedLean(const Context& context, const GaitMemory& memory) {
  const AnticipationGains& gains = context.gains.anticipation;
  const double missing_mps = context.goal.speed_mps - memory.speed.desired_mps;
  return std::clamp(gains.lean_rad_per_mps * missing_mps, -gains.lean_limit_rad,
                    gains.lean_limit_rad);
}

double AnticipatedCrouch(const Context& context, const GaitMemory& memory) {
  const bool waits = context.goal.gait == stream::Gait::kJump && !IsHopping(memory.gait);
  return waits ? context.gains.anticipation.crouch_m : 0;
}

}  // namespace footing::gait
