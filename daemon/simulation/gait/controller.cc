#include "daemon/simulation/gait/controller.h"

#include <algorithm>

#include "common/base/units.h"
#include "daemon/simulation/gait/anticipation.h"
#include "daemon/simulation/gait/frames.h"
#include "daemon/simulation/gait/leg_room.h"
#include "daemon/simulation/gait/running.h"
#include "daemon/simulation/gait/servo.h"
#include "daemon/simulation/gait/transition.h"
#include "daemon/simulation/gait/walking.h"

namespace footing::gait {
namespace {

/// Walking may begin a thrust and an absorbing Compression may end: then the other machine goes on
/// in the same step.
Targets AdvanceMachines(const Context& context, GaitMemory& memory) {
  const auto hops = [&memory] { return IsHopping(memory.gait) || memory.transition.thrusting; };
  const bool hopped = hops();
  const Targets targets =
      hopped ? AdvanceRunning(context, memory) : AdvanceWalking(context, memory);
  if (hops() == hopped) return targets;
  return hopped ? WalkingTargets(context, memory) : RunningTargets(context, memory);
}

}  // namespace

GaitMemory Standing(double heading_rad, double time_s) {
  GaitMemory memory;
  memory.heading_rad = heading_rad;
  memory.phase_start_s = time_s;
  return memory;
}

double StandingLength(const biped::BipedParameters& biped, const Gains& gains) {
  return std::clamp(gains.walking.hip_height_m, biped.leg_length_min_m, biped.leg_length_max_m);
}

physics::JointEfforts Advance(const biped::BodyState& body, const biped::BipedParameters& biped,
                              const Gains& gains, const biped::GaitCommand& command,
                              const stream::Track* seen_ground, double step_s, GaitMemory& memory) {
  const double speed_mps = ToHeading(memory.heading_rad, body.v_WC).x();
  const biped::GaitCommand goal = Goal(memory, command, gains.transition, speed_mps);
  const Context context{body, biped, gains, goal, seen_ground, step_s};
  SlewSpeed(context, memory);
  Targets targets = AdvanceMachines(context, memory);
  targets.lean_rad += AnticipatedLean(context, memory);
  KeepLegsApart(context, memory, targets);
  return Servo(targets, body, biped, gains, step_s, memory);
}

const char* PhaseName(const GaitMemory& memory) {
  return IsHopping(memory.gait) ? Name(memory.running) : Name(memory.walking);
}

stream::GaitState Describe(const biped::BodyState& body, const biped::GaitCommand& command,
                           const GaitMemory& memory) {
  stream::GaitState state;
  state.gait = memory.gait;
  state.commanded_gait =
      command.gait == stream::Gait::kUnspecified ? stream::Gait::kStep : command.gait;
  state.pending = state.gait != state.commanded_gait;
  state.phase = PhaseName(memory);
  state.commanded_speed_mps = command.speed_mps;
  state.commanded_height_m = command.height_m;
  state.commanded_turn_rad = command.turn_per_step_rad;
  state.speed_mps = ToHeading(memory.heading_rad, body.v_WC).x();
  state.heading_rad = WrapAngle(memory.heading_rad);
  state.steps = memory.steps;
  state.next_foothold_m = memory.foothold_W_m.head<2>();
  return state;
}

}  // namespace footing::gait
