#include <algorithm>
#include <cmath>

#include "daemon/simulation/gait/attitude.h"
#include "daemon/simulation/gait/foothold.h"
#include "daemon/simulation/gait/running.h"

namespace footing::gait {
namespace {

/// A jump's second leg is lengthened a little beyond the touchdown length to make contact.
constexpr double kReachM = 0.03;
/// Landing out of a jump, the springs rest this much shorter.
constexpr double kLandingShorterM = 0.06;
constexpr double kOverLengthM = 0.02;

LegTarget Placed(const Eigen::Vector3d& r_HF_W_m) {
  LegTarget target;
  target.task = LegTask::kPlace;
  target.r_HF_W_m = r_HF_W_m;
  return target;
}

/// Length the landing leg (both, in a jump) has in flight.
double FlightLength(const Context& context, const GaitMemory& memory) {
  const HoppingGains& gains = context.gains.hopping;
  const bool up = memory.running == RunningPhase::kUpwardFlight;
  if (memory.gait != stream::Gait::kJump) {
    return up ? gains.run_flight_length_m : gains.touchdown_length_m;
  }
  const double way =
      up ? 0 : std::clamp(context.TimeIn(memory) / gains.lengthening_time_s, 0.0, 1.0);
  return gains.jump_flight_length_m + way * (gains.touchdown_length_m - gains.jump_flight_length_m);
}

Eigen::Vector3d TowardsFoothold(const Context& context, const GaitMemory& memory, int leg,
                                double length_m) {
  return HipToFoot(context.body, leg, HoppingFoothold(context, memory, leg), length_m);
}

/// The idle leg opposite the other one. A leg has as much inertia about the hip as the body has in
/// roll: swung towards the side to which the body rolls, it holds the body back, in flight too.
LegTarget Opposite(const Context& context, const GaitMemory& memory,
                   const Eigen::Vector3d& other_r_HF_W_m) {
  const HoppingGains& gains = context.gains.hopping;
  const double left_rises = std::clamp(context.body.R_WB(2, 1), -1.0, 1.0);
  const double roll_rad = std::asin(left_rises) - BankAngle(memory, context.gains.attitude);
  return Placed(Mirrored(memory.heading_rad, other_r_HF_W_m, gains.idle_length_m,
                         gains.idle_roll_share * roll_rad));
}

Targets Flight(const Context& context, const GaitMemory& memory) {
  const double length_m = FlightLength(context, memory);
  Targets targets;
  const int front = memory.support_leg, rear = 1 - front;
  targets.legs[front] = Placed(TowardsFoothold(context, memory, front, length_m));
  targets.legs[rear] = memory.gait == stream::Gait::kJump
                           ? Placed(TowardsFoothold(context, memory, rear, length_m))
                           : Opposite(context, memory, targets.legs[front].r_HF_W_m);
  return targets;
}

/// The stance leg's spring, which only pushes.
AxialTarget RunSpring(const Context& context, const GaitMemory& memory) {
  const HoppingGains& gains = context.gains.hopping;
  const TransitionGains& landing = context.gains.transition;
  AxialTarget spring;
  spring.min_n = 0;
  spring.length_m = memory.running == RunningPhase::kCompression ? gains.touchdown_length_m
                                                                 : memory.thrust_length_m;
  spring.stiffness_n_per_m =
      memory.absorbing ? landing.run_landing_stiffness_n_per_m : gains.run_leg_stiffness_n_per_m;
  spring.damping_ns_per_m =
      memory.absorbing ? landing.run_landing_damping_ns_per_m : gains.run_leg_damping_ns_per_m;
  return spring;
}

Targets RunningStance(const Context& context, const GaitMemory& memory) {
  const int stance = memory.support_leg, idle = 1 - stance;
  const biped::LegState& leg = context.body.legs[stance];
  Targets targets;
  targets.legs[stance].task = leg.touching ? LegTask::kSupport : LegTask::kFree;
  targets.legs[stance].axial = RunSpring(context, memory);
  targets.legs[stance].hip_damping_nms_per_rad = context.gains.servo.free_hip_damping_nms_per_rad;
  targets.legs[idle] = Opposite(context, memory, leg.p_WF - leg.p_WH);
  return targets;
}

AxialTarget JumpSpring(const Context& context, const GaitMemory& memory,
                       const biped::LegState& leg) {
  const HoppingGains& gains = context.gains.hopping;
  const TransitionGains& landing = context.gains.transition;
  AxialTarget spring;
  spring.min_n = 0;
  if (memory.running == RunningPhase::kExtension) {
    spring.length_m = memory.thrust_length_m;
    if (leg.length_m > memory.thrust_length_m + kOverLengthM) return spring;
  } else {
    spring.length_m = gains.touchdown_length_m - (memory.absorbing ? kLandingShorterM : 0);
  }
  spring.stiffness_n_per_m =
      memory.absorbing ? landing.jump_landing_stiffness_n_per_m : gains.jump_leg_stiffness_n_per_m;
  spring.damping_ns_per_m =
      memory.absorbing ? landing.jump_landing_damping_ns_per_m : gains.jump_leg_damping_ns_per_m;
  return spring;
}

/// "If one leg reaches the ground before the other, the second leg is extended to make contact."
LegTarget Reaching(const Context& context, const GaitMemory& memory, int leg) {
  LegTarget target;
  target.task = LegTask::kPlaceHips;
  target.r_HF_W_m = TowardsFoothold(context, memory, leg, context.body.legs[leg].length_m);
  target.axial.length_m = context.gains.hopping.touchdown_length_m + kReachM;
  target.axial.stiffness_n_per_m = context.gains.servo.leg_stiffness_n_per_m / 2;
  target.axial.damping_ns_per_m = context.gains.servo.leg_damping_ns_per_m;
  return target;
}

Targets JumpingStance(const Context& context, const GaitMemory& memory) {
  Targets targets;
  for (int i = 0; i < 2; ++i) {
    const biped::LegState& leg = context.body.legs[i];
    if (leg.touching) {
      targets.legs[i].task = LegTask::kSupport;
      targets.legs[i].axial = JumpSpring(context, memory, leg);
    } else {
      targets.legs[i] = Reaching(context, memory, i);
    }
  }
  return targets;
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
  targets.jumping = jumping;
  return targets;
}

}  // namespace footing::gait
