#pragma once

#include <string>

#include "daemon/simulation/gait/controller.h"

/// Running and jumping over the ground that they see, and below them the changes of gait.
///
/// The ground is slopes, and steps up and down; pits.h has the pits. Without seen ground the
/// functions of the ground leave things as they are.
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

// Changes of gait: Figure 9 and "Gait Transitions" in section 5 of the paper.
//
// | from, to           | energy                                   | the controller changes     |
// |--------------------|------------------------------------------|----------------------------|
// | step <-> walk      | none                                     | at once                    |
// | step, walk -> run  | Fall extends the supporting leg          | when it leaves the ground  |
// | step, walk -> jump | the same                                 | the same                   |
// | run -> jump        | a preparatory step, foot under the COM   | when its leg lifts off     |
// | run -> walk, step  | run slows down; a foot far ahead absorbs | in Compression, to Rise    |
// | jump -> step, walk | jump slows down; both legs absorb        | to Double Support, by step |
// | jump -> run        | not in the paper: by stepping, walking   |                            |

/// True where the figure has an arrow (and for staying).
bool IsDirect(stream::Gait from, stream::Gait to);
/// Figure 9 as a Mermaid state diagram, drawn from IsDirect.
std::string DrawGaitChanges();

/// The command, or where there is no arrow the next gait on the way to it; turning no more than a
/// body of this speed along its heading can.
biped::GaitCommand Goal(const GaitMemory& memory, const biped::GaitCommand& command,
                        const TransitionGains& gains, double speed_mps);

/// True in the step of a run from which a jump begins: its thrust is the jump's first leap.
bool LeapsFromRun(const GaitMemory& memory);

/// True in a run that is to end, before a jump's preparatory step: it brakes harder, in lower hops.
bool LeavesRun(const Context& context, const GaitMemory& memory);

/// Moves v_d towards the goal's speed; a gait that is to be left for a slower one brakes first.
void SlewSpeed(const Context& context, GaitMemory& memory);

/// In Fall, late enough, with a goal that flies or faster than walking can be: begins the thrust.
/// After a push such a walk goes on as a run, which brakes and lands into walking again.
bool BeginThrust(const Context& context, GaitMemory& memory);
/// Begins it whatever the phase: the supporting leg extends by so much.
void StartThrust(const Context& context, double extension_m, GaitMemory& memory);
/// At lift-off: to the flight of the gait that follows.
void LiftOff(const Context& context, GaitMemory& memory);
/// Asked in flight: whether running's next step prepares a jump.
bool MayPrepareJump(const Context& context, const GaitMemory& memory);
/// At the apex, and again at touchdown: whether the Compression to come is to absorb, for walking
/// or stepping to follow. Asked at the apex first, so that the foot is placed for it.
bool MayLand(const Context& context, const GaitMemory& memory);
/// At the end of an absorbing Compression: running goes on with Rise, jumping with Double Support.
void LandIntoWalking(const Context& context, GaitMemory& memory);

}  // namespace footing::gait
