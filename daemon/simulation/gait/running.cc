#include "daemon/simulation/gait/running.h"

#include <algorithm>
#include <cmath>

#include "common/base/units.h"
#include "daemon/simulation/gait/cadence.h"
#include "daemon/simulation/gait/foothold.h"
#include "daemon/simulation/gait/ground_plan.h"
#include "daemon/simulation/gait/pit_sight.h"
#include "daemon/simulation/gait/touchdown.h"
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
/// Of a leap out of a run, which is faster than jumps are: as high as the fastest of those.
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

/// Counts steps that look like lift-off: the leg at its rest length (a light foot may well stay on
/// the ground then) or off the ground.
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
}

bool LandingDone(const Context& context, const GaitMemory& memory) {
  const double shortest_s = memory.gait == Gait::kJump ? kShortestJumpLandingS : kShortestLandingS;
  return memory.transition.absorbing && memory.running == RunningPhase::kCompression &&
         context.TimeIn(memory) > shortest_s &&
         StanceLeg(context, memory).rate_mps > kLandedRateMps;
}

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
      memory.hop.off_steps = 0;
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

}  // namespace footing::gait
