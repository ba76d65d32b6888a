#pragma once

#include <string>

#include "daemon/simulation/gait/context.h"

/// Changes of gait: Figure 9 and "Gait Transitions" in section 5 of the paper.
///
/// | from, to           | energy                                   | the controller changes     |
/// |--------------------|------------------------------------------|----------------------------|
/// | step <-> walk      | none                                     | at once                    |
/// | step, walk -> run  | Fall extends the supporting leg          | when it leaves the ground  |
/// | step, walk -> jump | the same                                 | the same                   |
/// | run -> jump        | a preparatory step, foot under the COM   | when its leg lifts off     |
/// | run -> walk, step  | run slows down; a foot far ahead absorbs | in Compression, to Rise    |
/// | jump -> step, walk | jump slows down; both legs absorb        | to Double Support, by step |
/// | jump -> run        | not in the paper: by stepping, walking   |                            |
namespace footing::gait {

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
