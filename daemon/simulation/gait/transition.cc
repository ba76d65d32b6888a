#include "daemon/simulation/gait/transition.h"

#include <algorithm>
#include <cmath>

#include "daemon/simulation/biped/limits.h"
#include "daemon/simulation/gait/cadence.h"
#include "daemon/simulation/gait/frames.h"
#include "daemon/simulation/gait/pit_sight.h"
#include "daemon/simulation/gait/walk_sight.h"

namespace footing::gait {
namespace {

using stream::Gait;

/// Thrust out of walking: the energy that the first, unmeasured lift-off is expected to lose.
constexpr double kThrustLossJ = 8;
constexpr double kFirstLossJ = 10;
/// A thrust out of walking counts as a support that began this long ago.
constexpr double kThrustSupportS = 0.1;

bool Flies(Gait gait) { return IsHopping(gait); }

double SpeedAlongHeading(const Context& context, const GaitMemory& memory) {
  return ToHeading(memory.heading_rad, context.body.v_WC).x();
}

/// In a run that jumps from one of its next steps: it keeps its speed for the leap.
bool RunsUp(const Context& context, const GaitMemory& memory) {
  return memory.gait == Gait::kRun && context.goal.gait == Gait::kJump &&
         (memory.transition.preparing_jump || JumpsPit(context.goal, memory) ||
          SpeedAlongHeading(context, memory) < context.gains.transition.run_to_jump_mps);
}

/// Smoothed duration of the supports: T of equation (2).
void MeasureSupport(double duration_s, GaitMemory& memory) {
  memory.hop.support_time_s =
      0.7 * memory.hop.support_time_s + 0.3 * std::clamp(duration_s, 0.1, 0.45);
}

}  // namespace

bool IsDirect(Gait from, Gait to) { return !(from == Gait::kJump && to == Gait::kRun); }

std::string DrawGaitChanges() {
  std::string text = "stateDiagram-v2\n";
  for (const Gait from : stream::kGaits) {
    for (const Gait to : stream::kGaits) {
      if (from == to || !IsDirect(from, to)) continue;
      text += std::string("  ") + stream::Name(from) + " --> " + stream::Name(to) + "\n";
    }
  }
  return text;
}

biped::GaitCommand Goal(const GaitMemory& memory, const biped::GaitCommand& command,
                        const TransitionGains& gains, double speed_mps) {
  biped::GaitCommand goal = command;
  if (goal.gait == Gait::kUnspecified) goal.gait = Gait::kStep;
  if (goal.gait == Gait::kStep) goal.speed_mps = 0;
  // A run that still brakes turns as its speed allows, not as the command's does; so does a leap,
  // which keeps a run's speed while v_d falls.
  const double allows_mps = memory.gait == Gait::kJump ? speed_mps : memory.speed.desired_mps;
  const double turn_max_rad = biped::TurnLimit(memory.gait, allows_mps);
  goal.turn_per_step_rad = std::clamp(goal.turn_per_step_rad, -turn_max_rad, turn_max_rad);
  if (!IsDirect(memory.gait, goal.gait)) {
    goal.gait = Gait::kWalk;
    goal.speed_mps = std::min(goal.speed_mps, gains.jump_speed_before_landing_mps);
  }
  return goal;
}

bool LeavesRun(const Context& context, const GaitMemory& memory) {
  return memory.gait == Gait::kRun && context.goal.gait != Gait::kRun && !RunsUp(context, memory);
}

bool LeapsFromRun(const GaitMemory& memory) {
  return memory.gait == Gait::kRun && memory.transition.preparing_jump;
}

void SlewSpeed(const Context& context, GaitMemory& memory) {
  const TransitionGains& limits = context.gains.transition;
  const bool to_ground = !Flies(context.goal.gait);
  const bool flying = Flies(memory.gait) || memory.transition.thrusting;
  double target_mps = context.goal.speed_mps;
  if (to_ground && memory.gait == Gait::kJump) {
    target_mps = std::min(target_mps, limits.jump_speed_before_landing_mps);
  } else if (to_ground && flying) {
    target_mps = std::min(target_mps, limits.run_to_walk_mps);
  }
  const bool in_flight =
      IsHopping(memory.gait) && (memory.running == RunningPhase::kUpwardFlight ||
                                 memory.running == RunningPhase::kDownwardFlight);
  const double speed_mps = SpeedAlongHeading(context, memory);
  if (RunsUp(context, memory)) {
    const double held_mps =
        in_flight ? std::min(memory.speed.desired_mps, speed_mps) : memory.speed.desired_mps;
    target_mps = std::max(target_mps, held_mps);
  }
  if (to_ground && !flying) target_mps = std::min(target_mps, SpeedBeforePit(context, memory));
  memory.speed.target_mps = target_mps;
  // Slowing down starts from the speed there is, not from one that was not reached yet.
  if (in_flight) {
    const double reached_mps = std::max(target_mps, speed_mps);
    memory.speed.desired_mps = std::min(memory.speed.desired_mps, reached_mps);
  }
  const double faster =
      (flying ? context.gains.hopping.acceleration_mps2 : context.gains.walking.acceleration_mps2) *
      context.step_s;
  const bool brakes = flying && memory.speed.desired_mps > 0;
  const double braking_mps2 =
      LeavesRun(context, memory) ? limits.leaving_run_mps2 : context.gains.hopping.braking_mps2;
  const double slower = brakes ? braking_mps2 * context.step_s : faster;
  memory.speed.desired_mps += std::clamp(target_mps - memory.speed.desired_mps, -slower, faster);
}

bool BeginThrust(const Context& context, GaitMemory& memory) {
  const TransitionGains& gains = context.gains.transition;
  const double swing = context.TimeIn(memory) / SwingTime(context, memory);
  const bool outrun = SpeedAlongHeading(context, memory) > context.gains.recovery.outrun_mps;
  if (!(outrun || Flies(context.goal.gait)) || memory.walking != WalkingPhase::kFall ||
      swing <= gains.thrust_from_swing) {
    return false;
  }
  const bool jump = context.goal.gait == Gait::kJump;
  const double lift_off_mps = jump ? gains.thrust_to_jump_mps : gains.thrust_to_run_mps;
  const double energy_j = context.biped.mass_kg() * lift_off_mps * lift_off_mps / 2 + kThrustLossJ;
  const double extension_m =
      std::sqrt(2 * energy_j / context.gains.hopping.run_leg_stiffness_n_per_m);
  memory.hop.thrust_length_m =
      std::clamp(context.body.legs[memory.support_leg].length_m + extension_m, 0.9,
                 context.biped.leg_length_max_m - 0.02);
  memory.transition.thrusting = true;
  memory.transition.preparing_jump = jump;
  memory.transition.absorbing = false;
  memory.running = RunningPhase::kExtension;
  memory.phase_start_s = context.body.time_s;
  memory.hop.touchdown_time_s = context.body.time_s - kThrustSupportS;
  memory.hop.off_steps = 0;
  memory.hop.support_time_s = context.gains.hopping.first_support_time_s;
  memory.hop.energy_loss_j = kFirstLossJ;
  memory.ground = {};
  memory.hop.leg_loss_j = {};
  return true;
}

void LiftOff(const Context& context, GaitMemory& memory) {
  MeasureSupport(context.body.time_s - memory.hop.touchdown_time_s, memory);
  const bool was_jumping = memory.gait == Gait::kJump;
  const bool jump = context.goal.gait == Gait::kJump;
  // A leap is high: it ends as a jump does, even when another gait is commanded by now.
  if (LeapsFromRun(memory) || (jump && (was_jumping || memory.transition.preparing_jump))) {
    memory.gait = Gait::kJump;
    memory.transition.preparing_jump = false;
  } else {
    memory.transition.preparing_jump = MayPrepareJump(context, memory);
    if (!was_jumping) memory.gait = Gait::kRun;
  }
  if (!was_jumping) memory.support_leg = 1 - memory.support_leg;
  memory.transition.thrusting = false;
  memory.transition.after_jump = false;
  memory.running = RunningPhase::kUpwardFlight;
  memory.phase_start_s = context.body.time_s;
}

bool MayPrepareJump(const Context& context, const GaitMemory& memory) {
  if (JumpsPit(context.goal, memory)) return JumpsFromNext(context, memory);
  return context.goal.gait == Gait::kJump && memory.gait != Gait::kJump &&
         SpeedAlongHeading(context, memory) < context.gains.transition.run_to_jump_mps;
}

bool MayLand(const Context& context, const GaitMemory& memory) {
  if (Flies(context.goal.gait)) return false;
  const TransitionGains& gains = context.gains.transition;
  const double speed_mps = SpeedAlongHeading(context, memory);
  if (memory.gait == Gait::kJump) return std::fabs(speed_mps) < gains.jump_to_step_mps;
  return speed_mps < gains.run_to_walk_mps + gains.run_to_walk_margin_mps;
}

void LandIntoWalking(const Context& context, GaitMemory& memory) {
  const Eigen::Vector3d v_H = ToHeading(memory.heading_rad, context.body.v_WC);
  if (memory.gait == Gait::kJump) {
    memory.gait = Gait::kStep;
    memory.transition.after_jump = true;
    memory.walking = WalkingPhase::kDoubleSupport;
    memory.support_leg = v_H.y() >= 0 ? biped::kLeft : biped::kRight;
    memory.speed.desired_mps = std::clamp(v_H.x(), -0.5, 1.2);
  } else {
    memory.gait = context.goal.gait == Gait::kStep ? Gait::kStep : Gait::kWalk;
    memory.walking = WalkingPhase::kRise;
    const TransitionGains& gains = context.gains.transition;
    memory.speed.desired_mps = std::clamp(v_H.x(), 0.0, gains.run_to_walk_mps + 0.3);
  }
  memory.transition.absorbing = false;
  memory.phase_start_s = context.body.time_s;
  memory.walking_step.swing_start_W_m = context.body.legs[1 - memory.support_leg].p_WF;
  // A body that landed low rises from there: extended at once to its walking height, a leg far
  // ahead would throw it up and back.
  memory.walking_step.support_height_m =
      context.body.legs[memory.support_leg].p_WH.z() - context.gains.walking.hip_height_m;
  memory.servo.followed = {};
}

}  // namespace footing::gait
