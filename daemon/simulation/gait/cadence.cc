#include "daemon/simulation/gait/cadence.h"

#include <algorithm>

#include "common/base/units.h"

namespace footing::gait {

double SwingTime(const Context& context, const GaitMemory& memory) {
  return memory.walking_step.swing_time_s > 0 ? memory.walking_step.swing_time_s
                                              : context.gains.walking.swing_time_s;
}

double CommandedSwingTime(const Context& context) {
  const WalkingGains& walking = context.gains.walking;
  const CadenceGains& limits = context.gains.cadence;
  if (!(context.goal.cadence_hz > 0)) return walking.swing_time_s;
  return std::clamp(1 / context.goal.cadence_hz - walking.double_support_time_s,
                    limits.swing_time_min_s, limits.swing_time_max_s);
}

double RunLiftOffSpeed(const Context& context, const GaitMemory& memory) {
  const CadenceGains& limits = context.gains.cadence;
  if (!(context.goal.cadence_hz > 0)) return context.gains.hopping.run_lift_off_mps;
  const double flight_s = 1 / context.goal.cadence_hz - memory.hop.support_time_s;
  return std::clamp(kStandardGravityMps2 * flight_s / 2, limits.run_lift_off_min_mps,
                    limits.run_lift_off_max_mps);
}

}  // namespace footing::gait
