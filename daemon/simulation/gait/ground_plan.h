#pragma once

#include "daemon/simulation/gait/context.h"

/// What running and jumping make of the ground they see: slopes, and steps up and down. Pits are
/// not this plan's. Without seen ground every function leaves things as they are.
///
/// On a slope s (rise over run) a hop is the level one sheared by s: vertical speeds are those
/// relative to the slope, v_z - s v_x, and the leg is shorter at touchdown and longer at lift-off
/// by s times the foot's distance from the COM.
namespace footing::gait {

/// At the lowest point of a support: how much faster or slower the coming lift-off is to be than
/// the gait's own, `lift_off_mps`, so that the touchdown after it, on the ground that is seen
/// there, has the gait's own speed. Sets memory.ground.
void PlanClimb(const Context& context, double lift_off_mps, GaitMemory& memory);

/// In flight, every step: where the foot will land, what moves it off an edge, and the height it
/// must keep until the edges before that are behind it. Sets memory.ground.
void PlanLanding(const Context& context, GaitMemory& memory);

/// Moves a foothold off an edge: by this much along the heading. Up to half a foot ball beside an
/// edge the foot slips off or hits the riser. `towards` > 0 wants the far side, < 0 the near one, 0
/// the nearer.
double ShiftOffEdge(const Context& context, double heading_rad, const Eigen::Vector3d& p_W_m,
                    double towards);

/// Length of the landing leg at touchdown with its foot `ahead_m` from the COM.
double TouchdownLength(const Context& context, const GaitMemory& memory, double ahead_m);

/// A standing leg relative to the slope, and the COM's speed upward from it. On no slope the leg's
/// length, its rate, and v_z.
struct SlopeLeg {
  double length_m, rate_mps;
};
SlopeLeg RelativeToSlope(const Context& context, const GaitMemory& memory, int leg);
double RisingSpeed(const Context& context, const GaitMemory& memory);

/// From hip to foot of a leg in flight, shortened where its foot must clear an edge: the landing
/// leg those before its foothold, the idle leg the next one too.
Eigen::Vector3d Cleared(const Context& context, const GaitMemory& memory, int leg,
                        const Eigen::Vector3d& r_HF_W_m);

/// The same for a leg that is not to land yet, kept off the ground itself. A body that a hard
/// landing left low has its hips little more than a leg's length up: a foot that scuffs trips it.
/// Unseen ground is level with the last foothold.
Eigen::Vector3d OffGround(const Context& context, const GaitMemory& memory, int leg,
                          const Eigen::Vector3d& r_HF_W_m);

}  // namespace footing::gait
