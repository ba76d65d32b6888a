#pragma once

#include <optional>

#include "daemon/simulation/gait/pit_plan.h"

/// The footholds of a walk up to a pit and over it. Distances are along the heading, from the
/// supporting foot.
///
/// Of a linear inverted pendulum the capture point xi = x + v / w moves away from the supporting
/// foot p by the factor e^(w T) in a step of time T. Footholds p_1, p_2, ... are reached, and the
/// walk goes on at its speed, when the first one lies at
///   p_1 = xi - sum_j d^j (p_(j+1) - p_j),   d = e^(-w T),
/// which with equal strides v_d T is equation (1). A longer stride is thus prepared by the
/// footholds before it.
namespace footing::gait {

/// The walk as it goes on when nothing lies ahead.
struct WalkAhead {
  double capture_m = 0;  ///< xi at the coming touchdown.
  double decay = 0.3;    ///< d.
  double stride_m = 0;   ///< v_d T, from foothold to foothold.
};

struct WalkLimits {
  double near_margin_m = 0.06;  ///< From the last foothold's centre to the near edge.
  double far_margin_m = 0.04;   ///< From the far edge to the first foothold behind it.
  double aim_margin_m = 0.03;   ///< Aimed at besides, at both.
  double stride_max_m = 0.70;
  double stride_min_m = -0.10;  ///< Of the strides before a pit.
};

/// Strides before a pit that are planned at most; further away it is not.
inline constexpr int kWalkStridesMax = 6;

/// The coming foothold, and how many there are before the pit with it: 0 steps over it.
struct WalkPlan {
  double foothold_m = 0;
  int strides = 0;
};

/// The foothold of a walk with nothing ahead.
double NaturalFoothold(const WalkAhead& walk);

/// Plans the footholds at a pit, not yet behind the supporting foot, that a stride can cross;
/// nothing when it is too far ahead. `strides` was planned before: it is kept when `decided`, else
/// preferred, since a change of mind moves the foothold in mid-swing.
std::optional<WalkPlan> PlanWalkOverPit(const WalkAhead& walk, const PitAhead& pit,
                                        const WalkLimits& limits, std::optional<int> strides,
                                        bool decided);

}  // namespace footing::gait
