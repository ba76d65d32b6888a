#include "daemon/simulation/gait/walk_sight.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "daemon/simulation/gait/pit_sight.h"

namespace footing::gait {
namespace {

/// Widths of pits are compared with this to spare, m: a heading askew makes them wider.
constexpr double kWidthSlackM = 0.005;
/// Nearer to the edge a swing foot does not change its mind.
constexpr double kDecidedWithinM = 0.15;

bool IsNarrow(const PitGains& gains, const PitAhead& pit) {
  return pit.far_m - pit.near_m <= gains.walk_width_max_m + kWidthSlackM;
}

}  // namespace

std::optional<WalkPlan> StepAtPit(const Context& context, const GaitMemory& memory,
                                  const PitAhead& pit, const WalkAhead& walk, double natural_m) {
  const PitGains& gains = context.gains.pit;
  if (pit.far_m <= 0) {  // Behind the supporting foot: the next one does not go back.
    const double earliest_m = pit.far_m + gains.walk.far_margin_m;
    if (natural_m >= earliest_m) return std::nullopt;
    return WalkPlan{earliest_m, 0};
  }
  const double latest_m = pit.near_m - gains.walk.near_margin_m;
  const bool before = latest_m > gains.walk.stride_min_m;
  const bool goes_over = IsNarrow(gains, pit) && memory.speed.desired_mps > gains.walk_slowest_mps;
  if (!goes_over && before) {
    if (natural_m <= latest_m) return std::nullopt;
    return WalkPlan{latest_m, 1};
  }
  // Once the swing foot is at the pit its side is decided.
  const std::optional<PitAhead> from_swing_foot =
      PitFrom(memory, context.body.legs[1 - memory.support_leg].p_WF);
  const bool decided =
      memory.walking == WalkingPhase::kFall && from_swing_foot->near_m < kDecidedWithinM;
  const std::optional<int> strides = memory.walking_step.strides_to_pit;
  if (decided && !strides) return std::nullopt;
  return PlanWalkOverPit(walk, pit, gains.walk, strides, decided);
}

double SpeedBeforePit(const Context& context, const GaitMemory& memory) {
  constexpr double kFree = std::numeric_limits<double>::infinity();
  const std::optional<PitAhead> pit = PitFrom(memory, context.body.p_WC);
  const PitGains& gains = context.gains.pit;
  if (!pit || pit->far_m < 0) return kFree;
  const bool narrow = IsNarrow(gains, *pit);
  const double least_mps = narrow ? gains.walk_over_mps : 0;
  const double left_m =
      std::max(0.0, pit->near_m - (narrow ? gains.walk_slow_m : gains.walk_stop_m));
  return std::sqrt(least_mps * least_mps + 2 * gains.walk_stop_mps2 * left_m);
}

}  // namespace footing::gait
