#include "daemon/simulation/gait/paper.h"

#include <algorithm>
#include <cmath>

#include "common/base/units.h"
#include "daemon/simulation/gait/foothold.h"
#include "daemon/simulation/gait/running.h"
#include "daemon/simulation/gait/transition.h"

namespace footing::gait {
namespace {

using Eigen::Vector3d;

/// Shorter states are chatter of the contact, s.
constexpr double kShortestSupportS = 0.02;
constexpr double kShortestFallS = 0.05;
/// Within this of its full length a leg carries no more, m.
constexpr double kExtendedM = 0.004;
/// A leg that reaches for the ground gets no longer, m.
constexpr double kLongestReachM = 1.1;
/// Angles of a leg are kept within this, rad.
constexpr double kLargestAngleRad = 0.7;

/// From the hip to the foot of a leg of this length that is turned forward by `pitch_rad` and to
/// the left by `left_rad`.
Vector3d LegAt(const GaitMemory& memory, double pitch_rad, double left_rad, double length_m) {
  const double pitch = std::clamp(pitch_rad, -kLargestAngleRad, kLargestAngleRad);
  const double left = std::clamp(left_rad, -kLargestAngleRad, kLargestAngleRad);
  return ToWorld(memory.heading_rad,
                 length_m * Vector3d(std::sin(pitch), std::cos(pitch) * std::sin(left),
                                     -std::cos(pitch) * std::cos(left)));
}

LegTarget PlacedAt(const Vector3d& r_HF_W_m) {
  LegTarget target;
  target.task = LegTask::kPlace;
  target.r_HF_W_m = r_HF_W_m;
  return target;
}

// Walking and stepping: Figure 5.

/// The rear leg's present extension beyond the touchdown length; it grows at a constant rate.
double Extension(const Context& context, const GaitMemory& memory, double full_m) {
  const double since_s = context.body.time_s - memory.walking_step.extends_since_s;
  return std::min(full_m, context.gains.paper.extension_mps * std::max(0.0, since_s));
}

LegTarget Standing(const Context& context, int leg, double length_m, double share) {
  const WalkingGains& gains = context.gains.walking;
  LegTarget target;
  target.task = LegTask::kSupport;
  target.axial.length_m = length_m;
  target.axial.stiffness_n_per_m = gains.leg_stiffness_n_per_m;
  target.axial.damping_ns_per_m = gains.leg_damping_ns_per_m;
  target.axial.feed_forward_n = share * gains.supported_mass_kg * kStandardGravityMps2 *
                                std::max(0.3, -context.body.legs[leg].u_HF_W.z());
  target.axial.min_n = 0;
  return target;
}

/// The swing leg at phi_W_d of equation (1), in pitch and in roll.
LegTarget Swinging(const Context& context, const GaitMemory& memory, int leg, double length_m) {
  const PaperGains& gains = context.gains.paper;
  const Vector3d v_H = ToHeading(memory.heading_rad, context.body.v_WC);
  const double pitch_rad = PaperWalkingAngle(gains.walk_offset_rad, gains.walk_gain_rad_per_mps,
                                             memory.speed.desired_mps, v_H.x());
  const double left_rad = PaperWalkingAngle(biped::Side(leg) * gains.walk_offset_side_rad,
                                            gains.walk_side_gain_rad_per_mps, 0, v_H.y());
  return PlacedAt(LegAt(memory, pitch_rad, left_rad, length_m));
}

Targets PaperWalkingTargets(const Context& context, const GaitMemory& memory) {
  const PaperGains& gains = context.gains.paper;
  const int support = memory.support_leg, other = 1 - support;
  const double length_m = gains.touchdown_length_m;
  Targets targets;
  switch (memory.walking) {
    case WalkingPhase::kDoubleSupport:
      targets.legs[support] = Standing(context, support, length_m, 0.5);
      targets.legs[other] = Standing(
          context, other, length_m + Extension(context, memory, gains.rear_extension_m), 0.5);
      break;
    case WalkingPhase::kRise:
      targets.legs[support] = Standing(context, support, length_m, 1);
      targets.legs[other] = Swinging(context, memory, other, gains.swing_length_m);
      break;
    case WalkingPhase::kFall:
      targets.legs[support] = Standing(
          context, support, length_m + Extension(context, memory, gains.fall_extension_m), 1);
      // "The swing leg is extended to make contact with the ground."
      targets.legs[other] =
          Swinging(context, memory, other,
                   std::min(length_m + gains.reach_mps * context.TimeIn(memory), kLongestReachM));
      break;
  }
  return targets;
}

WalkingCues SensePaperWalking(const Context& context, const GaitMemory& memory) {
  const PaperGains& gains = context.gains.paper;
  const biped::LegState& support = context.body.legs[memory.support_leg];
  const biped::LegState& other = context.body.legs[1 - memory.support_leg];
  const double time_s = context.TimeIn(memory);
  const double toward_mps =
      -biped::Side(memory.support_leg) * ToHeading(memory.heading_rad, context.body.v_WB).y();
  const bool steps = memory.gait == stream::Gait::kStep;
  const double full_m = gains.touchdown_length_m + gains.rear_extension_m;
  const bool pulled_up =
      time_s > kShortestSupportS && (!other.touching || other.length_m > full_m - kExtendedM);
  const bool rose = other.p_WF.z() - support.p_WF.z() > gains.rise_height_m &&
                    toward_mps > gains.rise_sideways_mps;
  const bool passed =
      ToHeading(memory.heading_rad, other.p_WF - support.p_WF).x() > gains.rise_passed_m ||
      toward_mps > gains.rise_sideways_mps;
  return {.double_support_over = (!steps && pulled_up) || time_s > gains.pick_up_s,
          .half_swing_over = steps ? rose : passed,
          .swing_foot_landed = time_s > kShortestFallS && other.touching};
}

void EnterPaper(WalkingPhase phase, const Context& context, GaitMemory& memory) {
  const int swing_leg = 1 - memory.support_leg;
  if (phase == WalkingPhase::kDoubleSupport) {
    memory.support_leg = swing_leg;
    memory.walking_step.landed_W_m = context.body.legs[swing_leg].p_WF;
    CountStep(context, memory);
  }
  memory.walking_step.extends_since_s = context.body.time_s;
  memory.phase_start_s = context.body.time_s;
  memory.walking = phase;
}

/// Remembers the idle leg, which is to stay as it is.
void KeepIdle(const Context& context, GaitMemory& memory) {
  const biped::LegState& idle = context.body.legs[1 - memory.support_leg];
  memory.hop.idle_r_HF_B_m = context.body.R_WB.transpose() * (idle.p_WF - idle.p_WH);
}

/// "If the user commands walking, the controller is immediately changed from stepping to walking";
/// the other way the walk first slows down.
void ChangeOnGround(const Context& context, GaitMemory& memory) {
  if (IsHopping(context.goal.gait)) return;
  const bool stops = memory.gait == stream::Gait::kWalk && context.goal.gait == stream::Gait::kStep;
  const double v_mps = ToHeading(memory.heading_rad, context.body.v_WC).x();
  if (stops && std::max(v_mps, memory.speed.desired_mps) > context.gains.paper.step_below_mps)
    return;
  memory.gait = context.goal.gait;
}

Targets AdvancePaperWalking(const Context& context, GaitMemory& memory) {
  ChangeOnGround(context, memory);
  if (memory.transition.after_jump && context.goal.gait == stream::Gait::kRun) {
    memory.gait = stream::Gait::kWalk;
  }
  memory.transition.after_jump = memory.transition.after_jump && IsHopping(context.goal.gait);
  const WalkingPhase next = Next(memory.walking, SensePaperWalking(context, memory));
  if (next != memory.walking) EnterPaper(next, context, memory);
  // "By extending the support leg during Fall."
  if (memory.walking == WalkingPhase::kFall && IsHopping(context.goal.gait)) {
    StartThrust(context, context.gains.paper.thrust_extension_m, memory);
    KeepIdle(context, memory);
    BeginExtension(memory.hop);
    return {};
  }
  const Targets targets = PaperWalkingTargets(context, memory);
  const int swing_leg = 1 - memory.support_leg;
  memory.foothold_W_m = context.body.legs[swing_leg].p_WH + targets.legs[swing_leg].r_HF_W_m;
  return targets;
}

// Running, and jumping as one copy of it with virtual legs: Figure 6.

/// A landing leg at phi_R_d of equation (2).
LegTarget Landing(const Context& context, const GaitMemory& memory, int leg, double length_m) {
  const HoppingGains& gains = context.gains.hopping;
  const bool jumping = memory.gait == stream::Gait::kJump;
  const double gain_s = -(jumping ? gains.jump_velocity_gain_s : gains.run_velocity_gain_s);
  const Vector3d v_H = ToHeading(memory.heading_rad, context.body.v_WC);
  const double pitch_rad =
      PaperRunningAngle(memory.hop.support_time_s, gain_s, memory.speed.desired_mps, v_H.x());
  double left_rad =
      PaperRunningAngle(memory.hop.support_time_s,
                        jumping ? gain_s : -context.gains.paper_hop.run_side_gain_s, 0, v_H.y());
  if (!jumping) {  // The foot comes to be under the body, not under the hip.
    const double inward_m = context.biped.hip_half_spacing_m - gains.run_foot_spacing_m;
    left_rad -= biped::Side(leg) * inward_m / gains.touchdown_length_m;
  }
  return PlacedAt(LegAt(memory, pitch_rad, left_rad, length_m));
}

Targets PaperFlight(const Context& context, const GaitMemory& memory) {
  const HoppingGains& gains = context.gains.hopping;
  const bool up = memory.running == RunningPhase::kUpwardFlight;
  Targets targets;
  if (memory.gait == stream::Gait::kJump) {
    for (int leg = 0; leg < 2; ++leg) {
      targets.legs[leg] =
          Landing(context, memory, leg, up ? gains.jump_flight_length_m : gains.touchdown_length_m);
    }
    return targets;
  }
  const int front = memory.support_leg, rear = 1 - front;
  targets.legs[front] =
      Landing(context, memory, front, up ? gains.run_flight_length_m : gains.touchdown_length_m);
  targets.legs[rear] =
      PlacedAt(Mirrored(memory.heading_rad, targets.legs[front].r_HF_W_m, gains.idle_length_m, 0));
  return targets;
}

LegTarget Pushing(const Context& context, const GaitMemory& memory, int leg) {
  const HoppingGains& gains = context.gains.hopping;
  const TransitionGains& landing = context.gains.transition;
  const bool jumping = memory.gait == stream::Gait::kJump;
  const bool extends = memory.running == RunningPhase::kExtension;
  LegTarget target;
  target.task = context.body.legs[leg].touching ? LegTask::kSupport : LegTask::kFree;
  target.hip_damping_nms_per_rad = context.gains.servo.free_hip_damping_nms_per_rad;
  target.axial.min_n = 0;
  target.axial.length_m = extends ? memory.hop.thrust_length_m : gains.touchdown_length_m;
  target.axial.stiffness_n_per_m =
      jumping ? gains.jump_leg_stiffness_n_per_m : gains.run_leg_stiffness_n_per_m;
  target.axial.damping_ns_per_m =
      jumping ? gains.jump_leg_damping_ns_per_m : gains.run_leg_damping_ns_per_m;
  if (memory.transition.absorbing) {
    target.axial.length_m += jumping ? -context.gains.paper_hop.landing_shortening_m
                                     : context.gains.paper_hop.landing_extension_m;
    target.axial.stiffness_n_per_m =
        jumping ? landing.jump_landing_stiffness_n_per_m : landing.run_landing_stiffness_n_per_m;
    target.axial.damping_ns_per_m =
        jumping ? landing.jump_landing_damping_ns_per_m : landing.run_landing_damping_ns_per_m;
  }
  return target;
}

/// "The idle leg maintains its length and orientation."
LegTarget Kept(const Context& context, const GaitMemory& memory) {
  return PlacedAt(context.body.R_WB * memory.hop.idle_r_HF_B_m);
}

Targets PaperStance(const Context& context, const GaitMemory& memory) {
  Targets targets;
  if (memory.gait == stream::Gait::kJump) {
    const bool leaves = OneLegLeft(memory);
    for (int leg = 0; leg < 2; ++leg) {
      // "If one leg reaches the ground before the other, the second leg is extended to make
      // contact. Similarly, if one leg leaves the ground first, the second leg is retracted."
      const double length_m =
          leaves ? context.gains.hopping.jump_flight_length_m : ReachingLength(context);
      targets.legs[leg] = context.body.legs[leg].touching && !leaves
                              ? Pushing(context, memory, leg)
                              : Landing(context, memory, leg, length_m);
    }
    return targets;
  }
  targets.legs[memory.support_leg] = Pushing(context, memory, memory.support_leg);
  targets.legs[1 - memory.support_leg] = Kept(context, memory);
  return targets;
}

Targets PaperRunningTargets(const Context& context, const GaitMemory& memory) {
  const bool flying = memory.running == RunningPhase::kUpwardFlight ||
                      memory.running == RunningPhase::kDownwardFlight;
  Targets targets = flying ? PaperFlight(context, memory) : PaperStance(context, memory);
  targets.hopping = true;
  targets.jumping = memory.gait == stream::Gait::kJump;
  return targets;
}

/// "In Extension the stance leg is extended": by a constant, in jumps by the height asked for.
double PaperThrustLength(const Context& context, const GaitMemory& memory) {
  const PaperHopGains& gains = context.gains.paper_hop;
  double extension_m = gains.run_extension_m;
  if (memory.gait == stream::Gait::kJump) {
    extension_m = gains.jump_extension_share * std::sqrt(context.goal.height_m);
  } else if (memory.transition.preparing_jump) {
    extension_m = gains.leap_extension_m;
  } else if (LeavesRun(context, memory)) {
    extension_m = gains.leaving_extension_m;
  }
  return context.gains.hopping.touchdown_length_m + extension_m;
}

void EnterPaper(RunningPhase phase, const Context& context, GaitMemory& memory) {
  switch (phase) {
    case RunningPhase::kCompression:
      memory.hop.touchdown_time_s = context.body.time_s;
      KeepIdle(context, memory);
      memory.transition.absorbing = MayLand(context, memory);
      CountStep(context, memory);
      break;
    case RunningPhase::kExtension:
      memory.transition.preparing_jump = MayPrepareJump(context, memory);
      memory.hop.thrust_length_m = PaperThrustLength(context, memory);
      BeginExtension(memory.hop);
      break;
    case RunningPhase::kUpwardFlight:
      LiftOff(context, memory);
      break;
    case RunningPhase::kDownwardFlight:
      break;
  }
  memory.running = phase;
  memory.phase_start_s = context.body.time_s;
}

Targets AdvancePaperRunning(const Context& context, GaitMemory& memory) {
  if (memory.running == RunningPhase::kExtension) WatchExtension(context, memory);
  const RunningPhase next = Next(memory.running, SenseRunning(context, memory));
  if (next != memory.running) EnterPaper(next, context, memory);
  if (LandingDone(context, memory)) {
    const bool ran = memory.gait == stream::Gait::kRun;
    LandIntoWalking(context, memory);
    if (ran) memory.gait = stream::Gait::kWalk;  // Stepping begins when the walk has slowed down.
    memory.walking_step.extends_since_s = context.body.time_s;
    return {};
  }
  const Targets targets = PaperRunningTargets(context, memory);
  const biped::LegState& leg = context.body.legs[memory.support_leg];
  memory.foothold_W_m = targets.legs[memory.support_leg].task == LegTask::kPlace
                            ? leg.p_WH + targets.legs[memory.support_leg].r_HF_W_m
                            : leg.p_WF;
  return targets;
}

}  // namespace

double PaperWalkingAngle(double offset_rad, double gain_rad_per_mps, double desired_mps,
                         double actual_mps) {
  return offset_rad + gain_rad_per_mps * (desired_mps - actual_mps);
}

double PaperRunningAngle(double support_time_s, double gain_s, double desired_mps,
                         double actual_mps) {
  return actual_mps * support_time_s / 2 + gain_s * (desired_mps - actual_mps);
}

Targets AdvancePaper(const Context& context, GaitMemory& memory) {
  return AdvanceMachines(
      {AdvancePaperWalking, AdvancePaperRunning, PaperWalkingTargets, PaperRunningTargets}, context,
      memory);
}

}  // namespace footing::gait
