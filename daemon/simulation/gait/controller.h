#pragma once

#include <optional>

#include "common/stream/character.h"
#include "daemon/simulation/biped/body_state.h"
#include "daemon/simulation/biped/world.h"
#include "daemon/simulation/gait/gains.h"
#include "daemon/simulation/gait/pits.h"
#include "daemon/simulation/gait/targets.h"

namespace footing::gait {

/// Inputs of one step of control. All borrowed for the call.
struct Context {
  const biped::BodyState& body;
  const biped::BipedParameters& biped;
  const Gains& gains;
  const biped::GaitCommand& goal;    ///< The command, or the next gait on the way to it.
  const stream::Track* seen_ground;  ///< Null: walking feels its way.
  double step_s = 0.001;

  double TimeIn(const GaitMemory& memory) const { return body.time_s - memory.phase_start_s; }
};

// The four gaits of section 5 as state machines over a floating body: command and body state in,
// joint efforts out.

/// Memory of a character that stands on both feet with this heading, stepping in place.
GaitMemory Standing(double heading_rad, double time_s);

/// Leg length at which Standing expects the legs, hips straight, m.
double StandingLength(const biped::BipedParameters& biped, const Gains& gains);

/// One step of control.
physics::JointEfforts Advance(const biped::BodyState& body, const biped::BipedParameters& biped,
                              const Gains& gains, const biped::GaitCommand& command,
                              const stream::Track* seen_ground, double step_s, GaitMemory& memory);

/// The name of the state in the paper's figures.
const char* PhaseName(const GaitMemory& memory);

/// Fills in what the controllers know; falls, distance and who commands are the engine's.
stream::GaitState Describe(const biped::BodyState& body, const biped::GaitCommand& command,
                           const GaitMemory& memory);

// Running and jumping towards a pit: finds it on the track, measures the hops, and turns the plan
// (pits.h) into what the gaits remember.

/// At lift-off and touchdown: remembers the pit ahead, if any.
void LookForPit(const Context& context, GaitMemory& memory);

/// The remembered pit as seen from a point, along the heading.
std::optional<PitAhead> PitFrom(const GaitMemory& memory, const Eigen::Vector3d& p_W_m);

/// At touchdown and lift-off: measures the hop, for the next one's prediction.
void NoteTouchdown(const Context& context, GaitMemory& memory);
void NoteLiftOff(const Context& context, GaitMemory& memory);

/// At lift-off: whether the coming foothold is the last one before the pit. `nominal_mps` is the
/// vertical lift-off speed when nothing lies ahead.
void ForeseeLeap(const Context& context, double nominal_mps, GaitMemory& memory);

/// At the leg's shortest: the vertical lift-off speed, if the pit asks for another than the nominal
/// one.
void PlanLiftOff(const Context& context, double nominal_mps, GaitMemory& memory);

/// The spring's extension for a lift-off at this vertical speed, by what the last hops lost.
double PlannedExtension(const Context& context, double lift_off_mps, const GaitMemory& memory);

/// True in a run whose commanded jump waits for the pit ahead.
bool JumpsPit(const biped::GaitCommand& goal, const GaitMemory& memory);

/// In the flight of such a run: whether the coming foothold is the one to jump from. A run that is
/// too fast to jump crosses the pit in its stride.
bool JumpsFromNext(const Context& context, const GaitMemory& memory);

/// In flight: how far to move the foothold off the pit; m along the heading.
double FootholdShift(const Context& context, const GaitMemory& memory);

/// Angular momentum of both legs about the whole COM, kg m2/s, world.
Eigen::Vector3d LegsMomentum(const biped::BodyState& body, const biped::BipedParameters& biped);

/// Angular momentum of the whole body about its COM, kg m2/s, world. In flight it does not change.
Eigen::Vector3d AngularMomentum(const biped::BodyState& body, const biped::BipedParameters& biped);

// Walking and stepping at the pit that LookForPit found: over a narrow one by its
// footholds; before a wide one they stop.

/// The coming foothold at a pit, seen from the supporting foot; nothing when it needs no plan.
/// `natural_m` is the foothold without a pit.
std::optional<WalkPlan> StepAtPit(const Context& context, const GaitMemory& memory,
                                  const PitAhead& pit, const WalkAhead& walk, double natural_m);

/// The speed at which a walk still stops before a pit that it may not cross, or slows down for one
/// that it steps over; infinite when it may go on as it does.
double SpeedBeforePit(const Context& context, const GaitMemory& memory);

/// Cues that Figure 5's machine needs of the present state.
WalkingCues SenseWalking(const Context& context, const GaitMemory& memory);

/// Control laws of the present state: walking, and stepping as walking at no speed.
Targets WalkingTargets(const Context& context, const GaitMemory& memory);

/// One step of walking or stepping: cues, transition, foothold, targets. A thrust that begins is
/// left to AdvanceRunning: then `memory.transition.thrusting` is set and the targets are empty.
Targets AdvanceWalking(const Context& context, GaitMemory& memory);

/// A machine of walking and one of running and jumping, each with the laws of its states.
struct Machines {
  Targets (*advance_walking)(const Context& context, GaitMemory& memory);
  Targets (*advance_running)(const Context& context, GaitMemory& memory);
  Targets (*walking_targets)(const Context& context, const GaitMemory& memory);
  Targets (*running_targets)(const Context& context, const GaitMemory& memory);
};

/// One step of the machine that is due. Walking may begin a thrust and an absorbing Compression may
/// end: then the other machine goes on in the same step.
Targets AdvanceMachines(const Machines& machines, const Context& context, GaitMemory& memory);

}  // namespace footing::gait
