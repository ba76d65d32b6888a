#pragma once

#include <optional>

/// The last foothold before a pit: how high each hop goes so that the strides end at the edge, and
/// how high the one that crosses it. Distances are along the heading, from a foothold.
///
/// A hop's stride grows with its flight, at any speed and without disturbing it: the foot is placed
/// where equation (2) wants it. So the vertical speed at lift-off is what is planned, and footholds
/// are shifted only by what is left over.
namespace footing::gait {

/// A pit on the way, distances along the heading.
struct PitAhead {
  double near_m = 0;  ///< From the foothold to the near edge; negative behind it.
  double far_m = 0;
  double rise_m = 0;  ///< Rise of the ground behind the pit over that before it.
};

/// Where a hop with a vertical lift-off speed lands:
///   stride = support + speed * FlightTime, from foothold to foothold.
struct Hop {
  double speed_mps = 0;
  double support_m = 0;        ///< Travel of the COM over the ground while a foot is down.
  double drop_m = 0;           ///< COM at lift-off over COM at touchdown, at `nominal_mps`.
  double drop_per_mps = 0.06;  ///< A faster lift-off is from a longer leg.
  double nominal_mps = 1.3;    ///< Vertical lift-off speed when nothing lies ahead.

  double FlightTime(double lift_off_mps, double rise_m = 0) const;
  double Stride(double lift_off_mps, double rise_m = 0) const;
  /// The vertical speed whose stride is `stride_m`; not limited.
  double LiftOffFor(double stride_m, double rise_m = 0) const;
};

/// The thrust: a spring under the body lifts it off, feet left behind until they are torn along.
///   (1 - loss) k x^2 / 2 = (m - feet) g x + m / (m - feet) m u^2 / 2
/// The leg is shortest while it slants, and the body passes over the foot during the thrust. It
/// then rises or falls with `bottom_mps` already, and the lift-off speed is
///   v = u + (a + b v) bottom_mps
/// with a and b fitted to hops before pits of 2.5 m at 6 m/s. They missed the planned speed by 0.45
/// m/s (root mean square) without this, and by 0.05 with it.
struct Thrust {
  double stiffness_n_per_m = 0;
  double mass_kg = 0;
  double feet_kg = 0;
  double loss_share = 0;  ///< Lost part of the spring's energy.
  double bottom_mps = 0;  ///< Vertical speed of the COM where the thrust begins.

  /// The compression x from which the lift-off speed v is reached.
  double ExtensionFor(double lift_off_mps) const;
  /// The loss that explains a lift-off.
  double LossShare(double extension_m, double lift_off_mps) const;
};

inline constexpr int kStridesMax = 4;  ///< Planned before the last foothold.

/// Limits of the hops up to a pit and over it.
struct PitLimits {
  double edge_margin_m = 0.06;     ///< From the foothold to the near edge.
  double landing_margin_m = 0.14;  ///< From the far edge to the foothold.
  double aim_margin_m = 0.06;      ///< Aimed at besides, at both.
  double lift_off_min_mps = 0.8;
  double lift_off_max_mps = 1.7;  ///< Limit for the strides before.
  double leap_max_mps = 3.2;      ///< Limit for the hop over the pit.
};

/// Plan of the hops up to a pit and over it.
struct PitPlan {
  bool leaps = false;       ///< The hop from this foothold crosses the pit.
  bool reaches = false;     ///< The plan stays within its limits.
  int strides = 0;          ///< Before the last foothold.
  double lift_off_mps = 0;  ///< Vertical, from this foothold.
};

/// Plans from a foothold. `first` is the hop from it, `next` those that follow.
PitPlan PlanPit(const PitAhead& pit, const Hop& first, const Hop& next, const PitLimits& limits);

/// How far to move a foothold that would come to lie in the pit or too near to an edge: to the
/// nearer side within [-back, ahead]; 0 when neither side can be reached or none needs to be.
/// `leaping` never goes back.
double ShiftOffPit(const PitAhead& pit, const PitLimits& limits, double back_m, double ahead_m,
                   bool leaping);

// The footholds of a walk up to a pit and over it. Distances are along the heading, from the
// supporting foot.
//
// The capture point xi = x + v / w of a linear inverted pendulum moves away from the supporting
// foot p by the factor e^(w T) in a step of time T. Footholds p_1, p_2, ... are reached, and the
// walk goes on at its speed, when the first one lies at
//   p_1 = xi - sum_j d^j (p_(j+1) - p_j),   d = e^(-w T),
// which with equal strides v_d T is equation (1). A longer stride is thus prepared by the
// footholds before it.

/// The walk as it goes on when nothing lies ahead.
struct WalkAhead {
  double capture_m = 0;  ///< xi at the coming touchdown.
  double decay = 0.3;    ///< d.
  double stride_m = 0;   ///< v_d T, from foothold to foothold.
};

/// Limits of the strides up to a pit and over it.
struct WalkLimits {
  double near_margin_m = 0.06;  ///< From the last foothold's centre to the near edge.
  double far_margin_m = 0.04;   ///< From the far edge to the first foothold behind it.
  double aim_margin_m = 0.03;   ///< Aimed at besides, at both.
  double stride_max_m = 0.70;
  double stride_min_m = -0.10;  ///< Limit for the strides before a pit.
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
