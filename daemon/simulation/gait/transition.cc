#include "daemon/simulation/gait/transition.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "common/base/units.h"
#include "daemon/simulation/biped/body_state.h"
#include "daemon/simulation/biped/ground.h"
#include "daemon/simulation/gait/controller.h"
#include "daemon/simulation/gait/foothold.h"
#include "daemon/simulation/gait/rough.h"
#include "daemon/simulation/gait/targets.h"

namespace footing::gait {
namespace {

using Eigen::Vector3d;

/// A flight's prediction repeats until the ground under the foothold agrees with its time.
constexpr int kRounds = 3;

terrain::Spot SpotAt(const Context& context, const Vector3d& p_W) {
  return terrain::Survey(*context.seen_ground, p_W.x(), p_W.y());
}

Vector3d Ahead(double heading_rad) { return ToWorld(heading_rad, {1, 0, 0}); }

/// Rise over run along a heading.
double SlopeAlong(const terrain::Spot& spot, double heading_rad) {
  return spot.slope * std::cos(heading_rad - spot.heading_rad);
}

/// Steps only: a pit's edges belong to another plan.
bool IsStep(const terrain::Edge& edge) { return std::isfinite(edge.distance_m) && !edge.pit; }

/// How far the foot's centre must stay from an edge on the near side, and on the far one.
double NearMargin(const SteppingGains& gains, const terrain::Edge& edge) {
  return edge.rise_m > 0 ? gains.low_margin_m : gains.high_margin_m;
}
double FarMargin(const SteppingGains& gains, const terrain::Edge& edge) {
  return edge.rise_m > 0 ? gains.high_margin_m : gains.low_margin_m;
}

/// Along the track, off the edge `past_m` behind the point (negative: ahead of it).
double Shift(const SteppingGains& gains, const terrain::Edge& edge, double past_m, double towards) {
  const double to_near_m = -NearMargin(gains, edge) - past_m;
  const double to_far_m = FarMargin(gains, edge) - past_m;
  if (to_near_m >= 0 || to_far_m <= 0) return 0;
  if (towards != 0) return towards > 0 ? to_far_m : to_near_m;
  return to_far_m < -to_near_m ? to_far_m : to_near_m;
}

/// COM below the hips with legs of these lengths.
double ComBelowHips(const biped::BipedParameters& biped, double one_m, double other_m) {
  const double knees_m = one_m + other_m - 2 * biped.foot_below_knee_link_com_m;
  return biped.link_mass_kg * (2 * biped.hip_link_com_below_hip_m + knees_m) / biped.mass_kg();
}

/// COM over the foot at touchdown, the foot `ahead_m` from the COM along the heading.
double TouchdownHeight(const Context& context, const GaitMemory& memory, double ahead_m) {
  const double length_m = TouchdownLength(context, memory, ahead_m);
  const double other_m =
      memory.gait == stream::Gait::kJump ? length_m : context.gains.hopping.idle_length_m;
  const double upright = std::sqrt(std::max(0.25, 1 - ahead_m * ahead_m / (length_m * length_m)));
  return upright * (length_m - ComBelowHips(context.biped, length_m, other_m));
}

/// An edge at p_WE, of ground at `height_m` on the foothold's side and `rise_m` more beyond.
EdgeMemory Kept(const terrain::Edge& edge, const Vector3d& p_WE, double height_m, double rise_m) {
  if (!IsStep(edge)) return {};
  return {.there = true, .p_W_m = p_WE, .height_m = height_m + std::max(0.0, rise_m)};
}

void KeepEdges(const Vector3d& foothold_W, const terrain::Spot& spot, const Vector3d& ahead_W,
               GroundMemory& ground) {
  const terrain::Edge& behind = spot.behind;
  const terrain::Edge& ahead = spot.ahead;
  ground.behind =
      Kept(behind, foothold_W - behind.distance_m * ahead_W, spot.height_m, -behind.rise_m);
  ground.ahead = Kept(ahead, foothold_W + ahead.distance_m * ahead_W, spot.height_m, ahead.rise_m);
}

/// Until a body that now rises at `v_mps` has come to be `down_m` lower, s.
double FallTime(double v_mps, double down_m) {
  const double root = v_mps * v_mps + 2 * kStandardGravityMps2 * down_m;
  return (v_mps + std::sqrt(std::max(0.0, root))) / kStandardGravityMps2;
}

}  // namespace

double ShiftOffEdge(const Context& context, double heading_rad, const Vector3d& p_W_m,
                    double towards) {
  const SteppingGains& gains = context.gains.stepping;
  const terrain::Spot spot = SpotAt(context, p_W_m);
  const double along = std::cos(heading_rad - spot.heading_rad);
  if (std::fabs(along) < 0.5) return 0;
  double shift_m = 0;
  if (IsStep(spot.behind)) shift_m = Shift(gains, spot.behind, spot.behind.distance_m, towards);
  if (shift_m == 0 && IsStep(spot.ahead)) {
    shift_m = Shift(gains, spot.ahead, -spot.ahead.distance_m, towards);
  }
  return shift_m / along;
}

double TouchdownLength(const Context& context, const GaitMemory& memory, double ahead_m) {
  const double length_m = context.gains.hopping.touchdown_length_m;
  if (memory.ground.slope == 0) return length_m;
  const double height_m = std::sqrt(std::max(0.1, length_m * length_m - ahead_m * ahead_m)) -
                          memory.ground.slope * ahead_m;
  return std::hypot(height_m, ahead_m);
}

SlopeLeg RelativeToSlope(const Context& context, const GaitMemory& memory, int leg) {
  const biped::LegState& state = context.body.legs[leg];
  const double slope = memory.ground.slope;
  if (slope == 0) return {state.length_m, state.length_rate_mps};
  const Vector3d r_H = ToHeading(memory.heading_rad, state.p_WF - state.p_WH);
  const Vector3d v_H = ToHeading(memory.heading_rad, -context.body.v_WC);  // The foot stands.
  const double length_m = (r_H - Vector3d(0, 0, slope * r_H.x())).norm();
  const double change_m2ps = state.length_m * state.length_rate_mps -
                             slope * (v_H.x() * r_H.z() + r_H.x() * v_H.z()) +
                             slope * slope * r_H.x() * v_H.x();
  return {length_m, change_m2ps / length_m};
}

double RisingSpeed(const Context& context, const GaitMemory& memory) {
  if (memory.ground.slope == 0) return context.body.v_WC.z();
  return context.body.v_WC.z() -
         memory.ground.slope * ToHeading(memory.heading_rad, context.body.v_WC).x();
}

void PlanClimb(const Context& context, double lift_off_mps, GaitMemory& memory) {
  memory.ground = {};
  if (context.seen_ground == nullptr) return;
  const SteppingGains& gains = context.gains.stepping;
  const Vector3d ahead_W = Ahead(memory.heading_rad);
  const double v_mps = context.body.v_WC.dot(ahead_W);
  const double half_m = v_mps * memory.hop.support_time_s / 2;
  const Vector3d& p_WF = context.body.legs[memory.support_leg].p_WF;
  const terrain::Spot from = SpotAt(context, p_WF);
  if (from.pit) return;
  memory.ground.slope = from.slope;
  KeepEdges(p_WF, from, ahead_W, memory.ground);

  double v_lift_off_mps = lift_off_mps + from.slope * v_mps;
  double down_m = 0;
  for (int round = 0; round < kRounds; ++round) {
    const double flight_m = v_mps * FallTime(v_lift_off_mps, down_m);
    Vector3d foothold_W = p_WF + (2 * half_m + flight_m) * ahead_W;
    const double shift_m = ShiftOffEdge(context, memory.heading_rad, foothold_W, 0);
    foothold_W += shift_m * ahead_W;
    const terrain::Spot to = SpotAt(context, foothold_W);
    if (to.pit) return;
    // COM's rise from lift-off, half_m past the one foot, to touchdown, half_m before the other.
    const double rise_m = to.height_m - from.height_m - half_m * (from.slope + to.slope);
    const double v_touchdown_mps = std::max(0.3, lift_off_mps - to.slope * v_mps);
    const double wanted = v_touchdown_mps * v_touchdown_mps + 2 * kStandardGravityMps2 * rise_m;
    // A change of flight time moves the foothold off the edge without a change of speed.
    const double later_s = std::fabs(v_mps) > gains.slowest_mps ? shift_m / v_mps : 0;
    const double longer_mps = std::clamp(kStandardGravityMps2 * later_s / 2, -gains.shift_limit_mps,
                                         gains.shift_limit_mps);
    v_lift_off_mps = std::sqrt(std::max(0.0, wanted)) + longer_mps;
    const double level_mps = lift_off_mps + from.slope * v_mps;
    v_lift_off_mps = std::clamp(v_lift_off_mps, level_mps - gains.slower_limit_mps,
                                level_mps + gains.faster_limit_mps);
    down_m = -rise_m;
  }
  memory.ground.climb_mps = v_lift_off_mps - from.slope * v_mps - lift_off_mps;
}

void PlanLanding(const Context& context, GaitMemory& memory) {
  if (context.seen_ground == nullptr) return;
  GroundMemory& ground = memory.ground;
  const SteppingGains& gains = context.gains.stepping;
  const Vector3d ahead_W = Ahead(memory.heading_rad);
  const biped::BodyState& body = context.body;
  ground.shift_m = 0;
  const Vector3d offset_W = HoppingFoothold(context, memory, memory.support_leg);
  const double ahead_m = offset_W.dot(ahead_W);

  double height_m = SpotAt(context, body.p_WC + offset_W).height_m;
  Vector3d foothold_W;
  terrain::Spot spot;
  for (int round = 0; round < kRounds; ++round) {
    const double com_m =
        height_m + context.biped.foot_radius_m + TouchdownHeight(context, memory, ahead_m);
    const double time_s = FallTime(body.v_WC.z(), body.p_WC.z() - com_m);
    foothold_W = body.p_WC + offset_W + time_s * body.v_WC;
    ground.shift_m =
        std::clamp(ShiftOffEdge(context, memory.heading_rad, foothold_W, ground.towards),
                   -gains.shift_limit_m, gains.shift_limit_m);
    foothold_W += ground.shift_m * ahead_W;
    spot = SpotAt(context, foothold_W);
    if (spot.pit) return;
    height_m = spot.height_m;
  }
  ground.slope = SlopeAlong(spot, memory.heading_rad);
  if (ground.shift_m != 0) ground.towards = ground.shift_m;
  KeepEdges(foothold_W, spot, ahead_W, ground);
}

Vector3d Cleared(const Context& context, const GaitMemory& memory, int leg,
                 const Vector3d& r_HF_W_m) {
  const SteppingGains& gains = context.gains.stepping;
  const biped::LegState& state = context.body.legs[leg];
  const Vector3d ahead_W = Ahead(memory.heading_rad);
  Vector3d r_W = r_HF_W_m;
  const bool lands = leg == memory.support_leg || memory.gait == stream::Gait::kJump;
  for (const EdgeMemory* edge : {&memory.ground.behind, &memory.ground.ahead}) {
    if (!edge->there || (lands && edge == &memory.ground.ahead)) continue;
    const double past_m = (state.p_WF - edge->p_W_m).dot(ahead_W);
    if (past_m > context.biped.foot_radius_m) continue;
    const double lowest_m = edge->height_m + context.biped.foot_radius_m + gains.clearance_m;
    r_W.z() = std::max(r_W.z(), lowest_m - state.p_WH.z());
    if (past_m > 0 || state.p_WF.z() > edge->height_m + context.biped.foot_radius_m) continue;
    // Still lower than the riser's top: up first, then over it.
    const double clearance_m = (edge->p_W_m - state.p_WH).dot(ahead_W) - gains.riser_margin_m;
    r_W -= std::max(0.0, r_W.dot(ahead_W) - clearance_m) * ahead_W;
  }
  r_W.z() = std::min(r_W.z(), std::max(r_HF_W_m.z(), -gains.shortest_leg_m));
  return r_W;
}

Eigen::Vector3d OffGround(const Context& context, const GaitMemory& memory, int leg,
                          const Eigen::Vector3d& r_HF_W_m) {
  const SteppingGains& gains = context.gains.stepping;
  const Vector3d& p_WH = context.body.legs[leg].p_WH;
  const Vector3d p_WF = p_WH + r_HF_W_m;
  const double standing_m =
      context.seen_ground == nullptr
          ? memory.pit.last_hop.foothold_z_m
          : context.biped.foot_radius_m +
                terrain::GroundHeight(*context.seen_ground, p_WF.x(), p_WF.y());
  const double lowest_m = standing_m + gains.clearance_m - p_WH.z();
  Vector3d r_W = r_HF_W_m;
  r_W.z() = std::max(r_W.z(), std::min(lowest_m, -gains.shortest_leg_m));
  return r_W;
}

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

namespace {

/// Where a walk looks for a slope, ahead of the COM: under it, and before it is there.
constexpr double kSlopeSightM[] = {0, 0.7, 1.4};

/// A walk of more than 1.35 m/s falls on slopes of 15 degrees: it is slower there, as people are.
double WalkOnSlope(double speed_mps, const Context& context, const GaitMemory& memory) {
  const SteppingGains& gains = context.gains.stepping;
  if (speed_mps <= gains.steep_walk_mps || context.seen_ground == nullptr) return speed_mps;
  const Vector3d ahead_W = Ahead(memory.heading_rad);
  const bool steep =
      std::any_of(std::begin(kSlopeSightM), std::end(kSlopeSightM), [&](double ahead_m) {
        const terrain::Spot spot = SpotAt(context, context.body.p_WC + ahead_m * ahead_W);
        return std::fabs(SlopeAlong(spot, memory.heading_rad)) > gains.steep;
      });
  return steep ? gains.steep_walk_mps : speed_mps;
}

}  // namespace

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
  if (to_ground && !flying) {
    target_mps = std::min(target_mps, SpeedBeforePit(context, memory));
    target_mps = WalkOnSlope(target_mps, context, memory);
  }
  target_mps = std::min(target_mps, SlantSpeed(context, memory));
  memory.speed.target_mps = target_mps;
  // Slowing down starts from the speed there is, not from one that was not reached yet.
  if (in_flight) {
    const double reached_mps = std::max(target_mps, speed_mps);
    memory.speed.desired_mps = std::min(memory.speed.desired_mps, reached_mps);
  }
  const double pace = GripPace(context);
  const double faster =
      (flying ? context.gains.hopping.acceleration_mps2 : context.gains.walking.acceleration_mps2) *
      pace * context.step_s;
  const bool brakes = flying && memory.speed.desired_mps > 0;
  const double braking_mps2 =
      LeavesRun(context, memory) ? limits.leaving_run_mps2 : context.gains.hopping.braking_mps2;
  const double slower = brakes ? braking_mps2 * pace * context.step_s : faster;
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
  StartThrust(context, std::sqrt(2 * energy_j / context.gains.hopping.run_leg_stiffness_n_per_m),
              memory);
  return true;
}

void StartThrust(const Context& context, double extension_m, GaitMemory& memory) {
  memory.hop.thrust_length_m =
      std::clamp(context.body.legs[memory.support_leg].length_m + extension_m, 0.9,
                 context.biped.leg_length_max_m - 0.02);
  memory.transition.thrusting = true;
  memory.transition.preparing_jump = context.goal.gait == Gait::kJump;
  memory.transition.absorbing = false;
  memory.running = RunningPhase::kExtension;
  memory.phase_start_s = context.body.time_s;
  memory.hop.touchdown_time_s = context.body.time_s - kThrustSupportS;
  memory.hop.off_steps = 0;
  memory.hop.support_time_s = context.gains.hopping.first_support_time_s;
  memory.hop.energy_loss_j = kFirstLossJ;
  memory.ground = {};
  memory.hop.leg_loss_j = {};
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
