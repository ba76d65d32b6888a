#include "daemon/simulation/gait/running.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "common/base/units.h"
#include "daemon/simulation/gait/controller.h"
#include "daemon/simulation/gait/foothold.h"
#include "daemon/simulation/gait/targets.h"
#include "daemon/simulation/gait/transition.h"

namespace footing::gait {
namespace {

using stream::Gait;

/// Times below which a cue is not believed, s: feet chatter at lift-off and touchdown.
constexpr double kEarliestLandingS = 0.08;
constexpr double kShortestCompressionS = 0.03;
constexpr double kShortestExtensionS = 0.02;
constexpr double kShortestLandingS = 0.04;
constexpr double kShortestJumpLandingS = 0.05;
constexpr int kLiftOffSteps = 2;
/// Rate of the leg's length, m/s, at which it counts as at its shortest, or as landed.
constexpr double kShortestRateMps = -0.02;
constexpr double kLandedRateMps = -0.15;
/// An extension that stalls (too long, too slow) is given more length.
constexpr double kStalledAfterS = 0.10;
constexpr double kStalledRateMps = 0.25;
constexpr double kStalledGrowthMps = 0.8;
constexpr double kLowestJumpM = 0.02;
/// Height of a leap out of a run, which is faster than jumps are: that of the fastest jump, m.
constexpr double kHighestLeapM = 0.5;
/// A jump may still be prepared this long after the apex: then its foothold can be reached, s.
constexpr double kPreparesUntilS = 0.05;

/// The stance leg, or both as one, relative to the slope.
struct VirtualLeg {
  double length_m, rate_mps;
  bool touching;
};

VirtualLeg StanceLeg(const Context& context, const GaitMemory& memory) {
  const auto& legs = context.body.legs;
  if (memory.gait == Gait::kJump) {
    const SlopeLeg left = RelativeToSlope(context, memory, 0);
    const SlopeLeg right = RelativeToSlope(context, memory, 1);
    return {(left.length_m + right.length_m) / 2, (left.rate_mps + right.rate_mps) / 2,
            legs[0].touching || legs[1].touching};
  }
  const SlopeLeg leg = RelativeToSlope(context, memory, memory.support_leg);
  return {leg.length_m, leg.rate_mps, legs[memory.support_leg].touching};
}

/// The gait's own; what the ground asks for comes on top.
double LevelLiftOffSpeed(const Context& context, const GaitMemory& memory) {
  if (LeavesRun(context, memory)) return context.gains.transition.leaving_run_lift_off_mps;
  const bool jumps = memory.gait == Gait::kJump || LeapsFromRun(memory);
  if (!jumps) return RunLiftOffSpeed(context, memory);
  double height_m = std::max(kLowestJumpM, context.goal.height_m);
  if (memory.gait != Gait::kJump) height_m = std::min(height_m, kHighestLeapM);
  return std::sqrt(2 * kStandardGravityMps2 * height_m);
}

double LiftOffSpeed(const Context& context, const GaitMemory& memory) {
  return LevelLiftOffSpeed(context, memory) + memory.ground.climb_mps;
}

/// Running, each leg has a share of its own: in a curve the inner and the outer one lose
/// differently, and one figure for both ends in high hops off the one and low hops off the other.
double EnergyLoss(const GaitMemory& memory) {
  if (memory.gait == Gait::kJump) return memory.hop.energy_loss_j;
  return memory.hop.energy_loss_j +
         memory.hop.leg_loss_j[static_cast<std::size_t>(memory.support_leg)];
}

/// The length the stance leg's spring is set to at the bottom, so that it stores what lift-off
/// needs: speed, height up to the touchdown length, and what the last hops lost. A pit may want
/// another speed than the gait does, for one hop.
double ThrustLength(const Context& context, const GaitMemory& memory) {
  const HoppingGains& gains = context.gains.hopping;
  const double length_m = StanceLeg(context, memory).length_m;
  const double mass_kg = context.biped.mass_kg();
  const double speed_mps = LiftOffSpeed(context, memory);
  const double rise_m = std::max(0.0, gains.touchdown_length_m - length_m) * 0.95;
  const double energy_j =
      std::max(0.0, mass_kg * speed_mps * speed_mps / 2 + mass_kg * kStandardGravityMps2 * rise_m +
                        EnergyLoss(memory));
  const double stiffness = memory.gait == Gait::kJump ? 2 * gains.jump_leg_stiffness_n_per_m
                                                      : gains.run_leg_stiffness_n_per_m;
  const double planned_mps = memory.pit.lift_off_mps > 0 ? memory.pit.lift_off_mps
                             : LeapsFromRun(memory)      ? speed_mps
                                                         : 0;
  const double extension_m = planned_mps > 0 ? PlannedExtension(context, planned_mps, memory)
                                             : std::sqrt(2 * energy_j / stiffness);
  return std::clamp(length_m + extension_m, gains.touchdown_length_m - 0.05,
                    gains.touchdown_length_m + 0.25);
}

void LearnEnergyLoss(const Context& context, GaitMemory& memory) {
  const double wanted_mps = LiftOffSpeed(context, memory);
  if (memory.pit.lift_off_mps != 0 || LeapsFromRun(memory)) return;
  const double reached_mps = RisingSpeed(context, memory);
  const double missing_j = context.biped.mass_kg() / 2 *
                           (wanted_mps * wanted_mps - reached_mps * std::fabs(reached_mps));
  memory.hop.energy_loss_j = std::clamp(memory.hop.energy_loss_j + 0.3 * missing_j, -40.0, 120.0);
  if (memory.gait == Gait::kJump) return;
  double& loss_j = memory.hop.leg_loss_j[static_cast<std::size_t>(memory.support_leg)];
  loss_j = std::clamp(loss_j + 0.5 * missing_j, -60.0, 60.0);
}

/// Whether one of a jump's legs has left the ground since both have pushed in this Extension.
void NoteLegThatLeft(const Context& context, GaitMemory& memory) {
  HopSupport& hop = memory.hop;
  for (std::size_t leg = 0; leg < 2; ++leg) {
    const bool touches = context.body.legs[leg].touching;
    hop.pushed[leg] = hop.pushed[leg] || touches;
    hop.leg_off_steps[leg] = touches ? 0 : hop.leg_off_steps[leg] + 1;
  }
  const int longest = std::max(hop.leg_off_steps[0], hop.leg_off_steps[1]);
  hop.leg_left = hop.pushed[0] && hop.pushed[1] && context.TimeIn(memory) > kShortestExtensionS &&
                 longest >= kLiftOffSteps;
}

}  // namespace

void WatchExtension(const Context& context, GaitMemory& memory) {
  const VirtualLeg leg = StanceLeg(context, memory);
  const double time_s = context.TimeIn(memory);
  const bool off = leg.length_m >= memory.hop.thrust_length_m || !leg.touching;
  if (!off && time_s > kStalledAfterS && leg.rate_mps < kStalledRateMps) {
    memory.hop.thrust_length_m =
        std::min(memory.hop.thrust_length_m + kStalledGrowthMps * context.step_s,
                 context.gains.hopping.touchdown_length_m + 0.2);
  }
  memory.hop.off_steps = off && time_s > kShortestExtensionS ? memory.hop.off_steps + 1 : 0;
  NoteLegThatLeft(context, memory);
}

void BeginExtension(HopSupport& hop) {
  hop.off_steps = 0;
  hop.pushed = {};
  hop.leg_left = false;
  hop.leg_off_steps = {};
}

bool OneLegLeft(const GaitMemory& memory) {
  return memory.running == RunningPhase::kExtension && memory.hop.leg_left;
}

bool LandingDone(const Context& context, const GaitMemory& memory) {
  const double shortest_s = memory.gait == Gait::kJump ? kShortestJumpLandingS : kShortestLandingS;
  return memory.transition.absorbing && memory.running == RunningPhase::kCompression &&
         context.TimeIn(memory) > shortest_s &&
         StanceLeg(context, memory).rate_mps > kLandedRateMps;
}

namespace {

void Enter(RunningPhase phase, const Context& context, GaitMemory& memory) {
  switch (phase) {
    case RunningPhase::kCompression:
      memory.hop.touchdown_time_s = context.body.time_s;
      NoteTouchdown(context, memory);
      CountStep(context, memory);
      memory.transition.absorbing = memory.transition.preparing_landing && MayLand(context, memory);
      memory.transition.preparing_landing = false;
      break;
    case RunningPhase::kExtension:
      PlanClimb(context, LevelLiftOffSpeed(context, memory), memory);
      PlanLiftOff(context, LiftOffSpeed(context, memory), memory);
      memory.hop.thrust_length_m = ThrustLength(context, memory);
      memory.pit.last_hop.extension_m =
          memory.hop.thrust_length_m - StanceLeg(context, memory).length_m;
      BeginExtension(memory.hop);
      break;
    case RunningPhase::kUpwardFlight:
      LearnEnergyLoss(context, memory);
      NoteLiftOff(context, memory);
      LiftOff(context, memory);
      ForeseeLeap(context, LiftOffSpeed(context, memory), memory);
      break;
    case RunningPhase::kDownwardFlight:
      memory.transition.preparing_landing = MayLand(context, memory);
      break;
  }
  memory.running = phase;
  memory.phase_start_s = context.body.time_s;
}

}  // namespace

RunningCues SenseRunning(const Context& context, const GaitMemory& memory) {
  const VirtualLeg leg = StanceLeg(context, memory);
  const double time_s = context.TimeIn(memory);
  return {.falling = RisingSpeed(context, memory) < 0,
          .landed_early = leg.touching && time_s > kEarliestLandingS,
          .landed = leg.touching,
          .leg_shortest = !memory.transition.absorbing && time_s > kShortestCompressionS &&
                          leg.rate_mps > kShortestRateMps,
          .lifted_off = memory.hop.off_steps >= kLiftOffSteps};
}

Targets AdvanceRunning(const Context& context, GaitMemory& memory) {
  const bool leaps = LeapsFromRun(memory) && memory.running == RunningPhase::kExtension;
  if (!memory.transition.thrusting && !leaps && context.goal.gait != Gait::kJump)
    memory.transition.preparing_jump = false;
  if (memory.running == RunningPhase::kExtension) WatchExtension(context, memory);
  const RunningPhase next = Next(memory.running, SenseRunning(context, memory));
  if (next != memory.running) Enter(next, context, memory);
  if (LandingDone(context, memory)) {
    LandIntoWalking(context, memory);
    return {};
  }
  const bool flying = memory.running == RunningPhase::kUpwardFlight ||
                      memory.running == RunningPhase::kDownwardFlight;
  if (flying) {
    const bool early = memory.running == RunningPhase::kUpwardFlight ||
                       context.TimeIn(memory) < kPreparesUntilS || memory.pit.last_foothold;
    memory.transition.preparing_jump =
        memory.transition.preparing_jump || (early && MayPrepareJump(context, memory));
    PlanLanding(context, memory);
    memory.pit.shift_m = FootholdShift(context, memory);
    memory.foothold_W_m = context.body.p_WC + HoppingFoothold(context, memory, memory.support_leg);
  }
  return RunningTargets(context, memory);
}

namespace {

/// A jump's second leg is lengthened a little beyond the touchdown length to make contact.
constexpr double kReachM = 0.03;
/// Landing out of a jump, the springs rest this much shorter.
constexpr double kLandingShorterM = 0.06;
constexpr double kOverLengthM = 0.02;
/// A run's hop over a pit with a faster lift-off than this is prepared like a jump's.
constexpr double kLongFlightMps = 1.7;

LegTarget Placed(const Eigen::Vector3d& r_HF_W_m) {
  LegTarget target;
  target.task = LegTask::kPlace;
  target.r_HF_W_m = r_HF_W_m;
  return target;
}

/// Length the landing leg (both, in a jump) has in flight, its foot `ahead_m` from the COM.
double FlightLength(const Context& context, const GaitMemory& memory, double ahead_m) {
  const HoppingGains& gains = context.gains.hopping;
  const double touchdown_m = TouchdownLength(context, memory, ahead_m);
  const bool up = memory.running == RunningPhase::kUpwardFlight;
  if (memory.gait != stream::Gait::kJump) {
    return up ? gains.run_flight_length_m : touchdown_m;
  }
  const double way =
      up ? 0 : std::clamp(context.TimeIn(memory) / gains.lengthening_time_s, 0.0, 1.0);
  return gains.jump_flight_length_m + way * (touchdown_m - gains.jump_flight_length_m);
}

double AheadOfCom(const GaitMemory& memory, const Eigen::Vector3d& offset_W_m) {
  return ToHeading(memory.heading_rad, offset_W_m).x();
}

/// A landing leg in flight.
LegTarget Landing(const Context& context, const GaitMemory& memory, int leg) {
  const Eigen::Vector3d offset_W = HoppingFoothold(context, memory, leg);
  const double length_m = FlightLength(context, memory, AheadOfCom(memory, offset_W));
  const Eigen::Vector3d r_HF_W =
      Cleared(context, memory, leg, HipToFoot(context.body, leg, offset_W, length_m));
  const bool rises = memory.running == RunningPhase::kUpwardFlight;
  return Placed(rises ? OffGround(context, memory, leg, r_HF_W) : r_HF_W);
}

/// A push on the body acts above the whole COM and leaves angular momentum for the whole flight.
/// The idle leg rolls on with the body, further than it, and so takes up most of that.
double IdleYield(const Context& context, const GaitMemory& memory) {
  const RecoveryGains& gains = context.gains.recovery;
  const double tilt_rad = TiltAside(context.body, memory, context.gains.attitude);
  return std::clamp(gains.idle_yield * tilt_rad, -gains.idle_yield_limit_rad,
                    gains.idle_yield_limit_rad);
}

/// In a curve the legs lie along the force, aslant: mirrored about the vertical the idle one would
/// cross the other.
double IdleAside(const Context& context, const GaitMemory& memory) {
  return IdleYield(context, memory) +
         context.gains.curve.idle_bank * BankAngle(memory, context.gains.attitude);
}

LegTarget Idle(const Context& context, const GaitMemory& memory, int leg,
               const Eigen::Vector3d& other_r_HF_W_m) {
  const Eigen::Vector3d mirrored_W =
      Mirrored(memory.heading_rad, other_r_HF_W_m, context.gains.hopping.idle_length_m,
               IdleAside(context, memory));
  return Placed(OffGround(context, memory, leg, Cleared(context, memory, leg, mirrored_W)));
}

/// Pushed aside at lift-off, a jump's body would turn over before it lands. The leg that it does
/// not fall towards swings out with it and takes up part of that; the other one lands.
LegTarget Yielding(const Context& context, const GaitMemory& memory, int leg, LegTarget target) {
  const RecoveryGains& gains = context.gains.recovery;
  const double outward_rad = biped::Side(leg) * Roll(context.body, memory);
  const double swing_rad = std::clamp(gains.jump_yield * (outward_rad - gains.jump_yield_from_rad),
                                      0.0, gains.idle_yield_limit_rad);
  const Eigen::Vector3d ahead_W = ToWorld(memory.heading_rad, {1, 0, 0});
  target.r_HF_W_m = Eigen::AngleAxisd(biped::Side(leg) * swing_rad, ahead_W) * target.r_HF_W_m;
  return target;
}

Targets Flight(const Context& context, const GaitMemory& memory) {
  Targets targets;
  if (memory.gait == stream::Gait::kJump) {
    for (int leg = 0; leg < 2; ++leg) {
      targets.legs[leg] = Yielding(context, memory, leg, Landing(context, memory, leg));
    }
    return targets;
  }
  const int front = memory.support_leg, rear = 1 - front;
  targets.legs[front] = Landing(context, memory, front);
  targets.legs[rear] = Idle(context, memory, rear, targets.legs[front].r_HF_W_m);
  return targets;
}

/// A spring that goes by the leg's length relative to the slope.
AxialTarget OnSlope(const Context& context, const GaitMemory& memory, int leg, AxialTarget spring) {
  const double relative_m = RelativeToSlope(context, memory, leg).length_m;
  spring.length_m += context.body.legs[leg].length_m - relative_m;
  return spring;
}

/// The stance leg's spring, which only pushes. A run that brakes to be left takes energy out while
/// the leg shortens: else the speed it loses becomes a high hop.
AxialTarget RunSpring(const Context& context, const GaitMemory& memory) {
  const HoppingGains& gains = context.gains.hopping;
  const TransitionGains& transition = context.gains.transition;
  const bool shortens = memory.running == RunningPhase::kCompression;
  AxialTarget spring;
  spring.min_n = 0;
  spring.length_m = shortens ? gains.touchdown_length_m : memory.hop.thrust_length_m;
  spring.stiffness_n_per_m = gains.run_leg_stiffness_n_per_m;
  spring.damping_ns_per_m = gains.run_leg_damping_ns_per_m;
  if (memory.transition.absorbing) {
    spring.stiffness_n_per_m = transition.run_landing_stiffness_n_per_m;
    spring.damping_ns_per_m = transition.run_landing_damping_ns_per_m;
  } else if (shortens && LeavesRun(context, memory)) {
    spring.damping_ns_per_m = transition.leaving_run_damping_ns_per_m;
  }
  return spring;
}

Targets RunningStance(const Context& context, const GaitMemory& memory) {
  const int stance = memory.support_leg, idle = 1 - stance;
  const biped::LegState& leg = context.body.legs[stance];
  Targets targets;
  targets.legs[stance].task = leg.touching ? LegTask::kSupport : LegTask::kFree;
  targets.legs[stance].axial = OnSlope(context, memory, stance, RunSpring(context, memory));
  targets.legs[stance].hip_damping_nms_per_rad = context.gains.servo.free_hip_damping_nms_per_rad;
  targets.legs[idle] = Idle(context, memory, idle, leg.p_WF - leg.p_WH);
  return targets;
}

AxialTarget JumpSpring(const Context& context, const GaitMemory& memory,
                       const biped::LegState& leg) {
  const HoppingGains& gains = context.gains.hopping;
  const TransitionGains& landing = context.gains.transition;
  AxialTarget spring;
  spring.min_n = 0;
  if (memory.running == RunningPhase::kExtension) {
    spring.length_m = memory.hop.thrust_length_m;
    if (leg.length_m > memory.hop.thrust_length_m + kOverLengthM) return spring;
  } else {
    spring.length_m =
        gains.touchdown_length_m - (memory.transition.absorbing ? kLandingShorterM : 0);
  }
  spring.stiffness_n_per_m = memory.transition.absorbing ? landing.jump_landing_stiffness_n_per_m
                                                         : gains.jump_leg_stiffness_n_per_m;
  spring.damping_ns_per_m = memory.transition.absorbing ? landing.jump_landing_damping_ns_per_m
                                                        : gains.jump_leg_damping_ns_per_m;
  return spring;
}

}  // namespace

double ReachingLength(const Context& context) {
  return context.gains.hopping.touchdown_length_m + kReachM;
}

namespace {

/// "If one leg reaches the ground before the other, the second leg is extended to make contact."
LegTarget Reaching(const Context& context, const GaitMemory& memory, int leg) {
  LegTarget target;
  target.task = LegTask::kPlaceHips;
  target.r_HF_W_m = HipToFoot(context.body, leg, HoppingFoothold(context, memory, leg),
                              context.body.legs[leg].length_m);
  target.axial.length_m = ReachingLength(context);
  target.axial.stiffness_n_per_m = context.gains.servo.leg_stiffness_n_per_m / 2;
  target.axial.damping_ns_per_m = context.gains.servo.leg_damping_ns_per_m;
  return target;
}

/// "If one leg leaves the ground first, the second leg is retracted to initiate flight."
LegTarget Retracting(const Context& context, const GaitMemory& memory, int leg) {
  return Placed(HipToFoot(context.body, leg, HoppingFoothold(context, memory, leg),
                          context.gains.hopping.jump_flight_length_m));
}

Targets JumpingStance(const Context& context, const GaitMemory& memory) {
  Targets targets;
  for (int i = 0; i < 2; ++i) {
    const biped::LegState& leg = context.body.legs[i];
    if (OneLegLeft(memory)) {
      targets.legs[i] = Retracting(context, memory, i);
    } else if (leg.touching) {
      targets.legs[i].task = LegTask::kSupport;
      targets.legs[i].axial = OnSlope(context, memory, i, JumpSpring(context, memory, leg));
    } else {
      targets.legs[i] = Reaching(context, memory, i);
    }
  }
  return targets;
}

/// A long flight would turn what one leg's support leaves in roll into a tilt: the legs' swing is
/// what the body is to take out before, and more, since both legs then spread.
void PrepareLongFlight(const Context& context, const GaitMemory& memory, Targets& targets) {
  const PitGains& gains = context.gains.pit;
  const Eigen::Vector3d legs_H =
      ToHeading(memory.heading_rad, LegsMomentum(context.body, context.biped));
  const double roll_radps =
      -gains.leap_roll_share * legs_H.x() / context.biped.body_inertia_roll_kgm2;
  targets.rate_W_radps = ToWorld(memory.heading_rad, {roll_radps, 0, 0});
  targets.lean_rad = gains.leap_lean_rad_per_mps * memory.speed.desired_mps;
}

/// A flight turns by the momentum of body and legs together, so that is what support damps
/// in roll and pitch, as if it were the body's own rate. In yaw it is in part: at lift-off the legs
/// swing against each other, and do so again before the next touchdown.
void DampWholeMomentum(const Context& context, const GaitMemory& memory, Targets& targets) {
  const biped::BipedParameters& biped = context.biped;
  const Eigen::Array3d inertia_kgm2(biped.body_inertia_roll_kgm2, biped.body_inertia_pitch_kgm2,
                                    biped.body_inertia_yaw_kgm2);
  const Eigen::Array3d share(1, 1, context.gains.attitude.hop_yaw_momentum_share);
  const Eigen::Array3d momentum_H =
      ToHeading(memory.heading_rad, AngularMomentum(context.body, biped));
  const Eigen::Array3d rate_H = ToHeading(memory.heading_rad, context.body.w_WB);
  targets.rate_W_radps =
      ToWorld(memory.heading_rad, (share * (rate_H - momentum_H / inertia_kgm2)).matrix());
}

}  // namespace

Targets RunningTargets(const Context& context, const GaitMemory& memory) {
  const bool jumping = memory.gait == stream::Gait::kJump;
  const bool flying = memory.running == RunningPhase::kUpwardFlight ||
                      memory.running == RunningPhase::kDownwardFlight;
  Targets targets = flying    ? Flight(context, memory)
                    : jumping ? JumpingStance(context, memory)
                              : RunningStance(context, memory);
  targets.hopping = true;
  const bool leaps = memory.pit.leaping &&
                     (memory.transition.preparing_jump || memory.pit.lift_off_mps > kLongFlightMps);
  if (!jumping) {
    targets.lean_rad = context.gains.style.lean_rad_per_mps * memory.speed.desired_mps;
  }
  if (leaps && !flying && !jumping) {
    PrepareLongFlight(context, memory, targets);
  } else if (!flying) {
    DampWholeMomentum(context, memory, targets);
  }
  targets.jumping = jumping;
  if (jumping) targets.flight_s = 2 * std::sqrt(2 * context.goal.height_m / kStandardGravityMps2);
  return targets;
}

}  // namespace footing::gait
