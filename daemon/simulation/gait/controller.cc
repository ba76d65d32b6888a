#include "daemon/simulation/gait/controller.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include "common/base/units.h"
#include "daemon/simulation/biped/ground.h"
#include "daemon/simulation/gait/foothold.h"
#include "daemon/simulation/gait/paper.h"
#include "daemon/simulation/gait/rough.h"
#include "daemon/simulation/gait/running.h"
#include "daemon/simulation/gait/style.h"
#include "daemon/simulation/gait/targets.h"
#include "daemon/simulation/gait/transition.h"

namespace footing::gait {
Targets AdvanceMachines(const Machines& machines, const Context& context, GaitMemory& memory) {
  const auto hops = [&memory] { return IsHopping(memory.gait) || memory.transition.thrusting; };
  const bool hopped = hops();
  const Targets targets = hopped ? machines.advance_running(context, memory)
                                 : machines.advance_walking(context, memory);
  if (hops() == hopped) return targets;
  return hopped ? machines.walking_targets(context, memory)
                : machines.running_targets(context, memory);
}

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
  if (gains.paper.laws > 0.5) {
    return Servo(AdvancePaper(context, memory), body, biped, gains, step_s, memory);
  }
  FeelTow(context, memory);
  Targets targets = AdvanceMachines(
      {AdvanceWalking, AdvanceRunning, WalkingTargets, RunningTargets}, context, memory);
  targets.lean_rad += AnticipatedLean(context, memory);
  KeepLegsApart(context, memory, targets);
  FadeStyle(context, memory);
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

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kSightM = 8;
/// Pits that are crossed at a steeper angle than this are not planned for.
constexpr double kLeastCosine = 0.5;

Vector2d AheadOnPath(double heading_rad) { return {std::cos(heading_rad), std::sin(heading_rad)}; }

double GroundAtEnd(const stream::TrackSegment& segment) {
  return segment.start_m.z() + segment.length_m * std::sin(segment.slope_rad);
}

/// Rise of the COM until lift-off per extension of the spring; the rest is learned.
constexpr double kRiseShare = 0.87;
/// Weight of a new measure in the remembered one.
constexpr double kSmoothing = 0.3;

/// The foot that carries or will carry; between both in jumping.
Vector3d StanceFoot(const Context& context, const GaitMemory& memory) {
  const auto& legs = context.body.legs;
  if (memory.gait == stream::Gait::kJump) return (legs[0].p_WF + legs[1].p_WF) / 2;
  return legs[memory.support_leg].p_WF;
}

/// COM relative to the stance foot, in the heading frame.
Vector3d FromFoot(const Context& context, const GaitMemory& memory) {
  return ToHeading(memory.heading_rad, context.body.p_WC - StanceFoot(context, memory));
}

/// Where the COM will touch down, if no foot shifts: on ground as high as the last foothold's, and
/// behind a pit as much higher.
Vector3d PlaceAtTouchdown(const Context& context, const GaitMemory& memory) {
  const PitMemory& seen = memory.pit;
  const HopMeasures& last = seen.last_hop;
  const double height_m =
      last.foothold_z_m + last.touchdown_height_m + (seen.leaping ? seen.sighting.rise_m : 0);
  const double vz = context.body.v_WC.z();
  const double over_m = context.body.p_WC.z() - height_m;
  const double flight_s =
      (vz + std::sqrt(std::max(0.0, vz * vz + 2 * kStandardGravityMps2 * over_m))) /
      kStandardGravityMps2;
  return context.body.p_WC + std::max(0.0, flight_s) * context.body.v_WC;
}

/// A hop as the last one was.
Hop SteadyHop(const GaitMemory& memory, double nominal_mps) {
  const HopMeasures& last = memory.pit.last_hop;
  return {.speed_mps = last.flight_mps,
          .support_m = last.com_ahead_m + last.foot_ahead_m,
          .drop_m = last.drop_m,
          .nominal_mps = nominal_mps};
}

Thrust ThrustOf(const Context& context, const GaitMemory& memory) {
  const HoppingGains& gains = context.gains.hopping;
  const bool jumping = memory.gait == stream::Gait::kJump;
  return {.stiffness_n_per_m =
              jumping ? 2 * gains.jump_leg_stiffness_n_per_m : gains.run_leg_stiffness_n_per_m,
          .mass_kg = context.biped.mass_kg(),
          .feet_kg = (jumping ? 2 : 1) * context.biped.link_mass_kg,
          .loss_share = memory.pit.last_hop.loss_share,
          .bottom_mps = memory.pit.last_hop.bottom_mps};
}

/// Jumping's legs, drawn in, need time to come down again.
PitLimits LimitsOf(const PitGains& gains, const GaitMemory& memory) {
  PitLimits limits = gains.limits;
  if (memory.gait == stream::Gait::kJump) limits.lift_off_min_mps = gains.jump_lift_off_min_mps;
  return limits;
}

bool Plans(const PitAhead& pit, const PitPlan& plan, double sight_m) {
  return plan.reaches || pit.near_m < sight_m;
}

}  // namespace

void LookForPit(const Context& context, GaitMemory& memory) {
  PitSighting& seen = memory.pit.sighting;
  seen.ahead = false;
  if (context.seen_ground == nullptr) return;
  const auto& segments = context.seen_ground->segments;
  const Vector2d p_W = context.body.p_WC.head<2>();
  const Vector2d ahead = AheadOnPath(memory.heading_rad);
  double nearest_m = kSightM;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    if (!segments[i].pit || (i > 0 && segments[i - 1].pit)) continue;
    const stream::TrackSegment& first = segments[i];
    const Vector2d along = AheadOnPath(first.heading_rad);
    const Vector2d offset = p_W - first.start_m.head<2>();
    const double sideways_m = along.x() * offset.y() - along.y() * offset.x();
    if (std::fabs(sideways_m) > first.width_m || along.dot(ahead) < kLeastCosine) continue;
    double length_m = 0;
    std::size_t end = i;
    while (end < segments.size() && segments[end].pit) {
      length_m += segments[end].length_m * std::cos(segments[end].slope_rad);
      ++end;
    }
    const double to_near_m = -offset.dot(along);
    if (to_near_m + length_m < 0 || to_near_m > nearest_m) continue;
    nearest_m = to_near_m;
    const double before_m = i > 0 ? GroundAtEnd(segments[i - 1]) : first.start_m.z();
    const double behind_m = end < segments.size() ? segments[end].start_m.z() : before_m;
    seen.ahead = true;
    seen.near_W_m = first.start_m.head<2>();
    seen.along_W = along;
    seen.length_m = length_m;
    seen.rise_m = behind_m - before_m;
  }
}

std::optional<PitAhead> PitFrom(const GaitMemory& memory, const Vector3d& p_W_m) {
  const PitSighting& seen = memory.pit.sighting;
  if (!seen.ahead) return std::nullopt;
  const double cosine = std::max(kLeastCosine, seen.along_W.dot(AheadOnPath(memory.heading_rad)));
  const double near_m = (seen.near_W_m - p_W_m.head<2>()).dot(seen.along_W) / cosine;
  return PitAhead{near_m, near_m + seen.length_m / cosine, seen.rise_m};
}

void NoteTouchdown(const Context& context, GaitMemory& memory) {
  PitMemory& seen = memory.pit;
  HopMeasures& last = seen.last_hop;
  const Vector3d r_FC_H = FromFoot(context, memory);
  last.foothold_z_m = StanceFoot(context, memory).z();
  last.touchdown_height_m += kSmoothing * (r_FC_H.z() - last.touchdown_height_m);
  last.foot_ahead_m = -r_FC_H.x() - seen.shift_m;
  last.flight_mps = ToHeading(memory.heading_rad, context.body.v_WC).x();
  seen.leaping = false;
  seen.shift_m = 0;
}

void NoteLiftOff(const Context& context, GaitMemory& memory) {
  PitMemory& seen = memory.pit;
  HopMeasures& last = seen.last_hop;
  const Vector3d r_FC_H = FromFoot(context, memory);
  last.com_ahead_m = r_FC_H.x();
  const double drop_m = r_FC_H.z() - last.touchdown_height_m;
  if (seen.lift_off_mps == 0) last.drop_m += kSmoothing * (drop_m - last.drop_m);
  if (last.extension_m > 0) {
    const double time_s = std::clamp(context.TimeIn(memory), 0.05, 0.15);
    last.extension_time_s += kSmoothing * (time_s - last.extension_time_s);
    const double rise_m = r_FC_H.z() - last.bottom_height_m - kRiseShare * last.extension_m;
    last.rise_offset_m += kSmoothing * (std::clamp(rise_m, -0.1, 0.05) - last.rise_offset_m);
    const double share =
        ThrustOf(context, memory).LossShare(last.extension_m, context.body.v_WC.z());
    last.loss_share += kSmoothing * (std::clamp(share, 0.1, 0.4) - last.loss_share);
  }
  last.extension_m = 0;
  seen.lift_off_mps = 0;
}

void ForeseeLeap(const Context& context, double nominal_mps, GaitMemory& memory) {
  PitMemory& seen = memory.pit;
  seen.planned = seen.last_foothold = false;
  LookForPit(context, memory);
  if (!seen.sighting.ahead) return;
  const Vector3d p_WF =
      PlaceAtTouchdown(context, memory) + HoppingFoothold(context, memory, memory.support_leg);
  const std::optional<PitAhead> pit = PitFrom(memory, p_WF);
  const Hop hop = SteadyHop(memory, nominal_mps);
  const PitGains& gains = context.gains.pit;
  const PitPlan plan = PlanPit(*pit, hop, hop, LimitsOf(gains, memory));
  seen.planned = Plans(*pit, plan, gains.sight_m);
  seen.last_foothold = seen.planned && plan.leaps;
  if (JumpsPit(context.goal, memory))
    memory.transition.preparing_jump = JumpsFromNext(context, memory);
}

void PlanLiftOff(const Context& context, double nominal_mps, GaitMemory& memory) {
  PitMemory& seen = memory.pit;
  HopMeasures& last = seen.last_hop;
  seen.lift_off_mps = 0;
  seen.leaping = seen.planned = false;
  last.bottom_height_m = FromFoot(context, memory).z();
  last.bottom_mps = context.body.v_WC.z();
  LookForPit(context, memory);
  if (!seen.sighting.ahead) return;
  const PitGains& gains = context.gains.pit;
  const std::optional<PitAhead> pit = PitFrom(memory, StanceFoot(context, memory));
  const Hop next = SteadyHop(memory, nominal_mps);
  Hop first = next;
  first.support_m =
      FromFoot(context, memory).x() + last.flight_mps * last.extension_time_s + last.foot_ahead_m;
  first.drop_m = FromFoot(context, memory).z() +
                 kRiseShare * ThrustOf(context, memory).ExtensionFor(nominal_mps) +
                 last.rise_offset_m - last.touchdown_height_m;
  const PitPlan plan = PlanPit(*pit, first, next, LimitsOf(gains, memory));
  const bool may_leap = context.goal.gait == stream::Gait::kJump ||
                        memory.gait == stream::Gait::kJump ||
                        pit->far_m - pit->near_m <= gains.run_width_max_m;
  seen.planned = Plans(*pit, plan, gains.sight_m);
  seen.leaping = seen.planned && plan.leaps && may_leap;
  if (JumpsPit(context.goal, memory)) {
    memory.transition.preparing_jump = seen.leaping && last.flight_mps < gains.jump_speed_max_mps;
  }
  if (seen.planned && (!plan.leaps || seen.leaping)) seen.lift_off_mps = plan.lift_off_mps;
}

double PlannedExtension(const Context& context, double lift_off_mps, const GaitMemory& memory) {
  return ThrustOf(context, memory).ExtensionFor(lift_off_mps);
}

bool JumpsPit(const biped::GaitCommand& goal, const GaitMemory& memory) {
  return goal.gait == stream::Gait::kJump && memory.gait == stream::Gait::kRun &&
         memory.pit.sighting.ahead && memory.pit.planned;
}

bool JumpsFromNext(const Context& context, const GaitMemory& memory) {
  const double speed_mps = ToHeading(memory.heading_rad, context.body.v_WC).x();
  return memory.pit.last_foothold && speed_mps < context.gains.pit.jump_speed_max_mps;
}

double FootholdShift(const Context& context, const GaitMemory& memory) {
  if (!memory.pit.sighting.ahead) return 0;
  const PitGains& gains = context.gains.pit;
  const Vector3d shifted_W = HoppingFoothold(context, memory, memory.support_leg);
  const Vector3d shift_W = ToWorld(memory.heading_rad, Vector3d(memory.pit.shift_m, 0, 0));
  const std::optional<PitAhead> pit =
      PitFrom(memory, PlaceAtTouchdown(context, memory) + shifted_W - shift_W);
  const double speed_mps = std::max(0.0, ToHeading(memory.heading_rad, context.body.v_WC).x());
  const double ahead_m = std::min(gains.shift_ahead_m, gains.shift_ahead_s * speed_mps);
  return ShiftOffPit(*pit, gains.limits, gains.shift_back_m, ahead_m, memory.pit.leaping);
}

namespace {

/// Angular momentum of one link: its centre's motion about the COM, and its own spin.
Vector3d LinkMomentum(const biped::BodyState& body, const biped::BipedParameters& biped,
                      const Vector3d& p_W, const Vector3d& v_W, const Vector3d& u_W,
                      const Vector3d& w_W) {
  const double along = u_W.dot(w_W);
  return biped.link_mass_kg * (p_W - body.p_WC).cross(v_W - body.v_WC) +
         biped.link_inertia_across_kgm2 * (w_W - along * u_W) +
         biped.link_inertia_along_kgm2 * along * u_W;
}

}  // namespace

Vector3d LegsMomentum(const biped::BodyState& body, const biped::BipedParameters& biped) {
  Vector3d momentum = Vector3d::Zero();
  for (const biped::LegState& leg : body.legs) {
    const Vector3d w_W =
        body.w_WB + leg.hinge_axes_W * Vector3d(leg.joint_velocity[0], leg.joint_velocity[1],
                                                leg.joint_velocity[2]);
    const Vector3d v_WH = body.v_WB + body.w_WB.cross(leg.p_WH - body.p_WB);
    const Vector3d& u_W = leg.u_HF_W;
    const Vector3d r_hip_link = biped.hip_link_com_below_hip_m * u_W;
    const Vector3d r_knee_link = (leg.length_m - biped.foot_below_knee_link_com_m) * u_W;
    momentum +=
        LinkMomentum(body, biped, leg.p_WH + r_hip_link, v_WH + w_W.cross(r_hip_link), u_W, w_W);
    momentum += LinkMomentum(body, biped, leg.p_WH + r_knee_link,
                             v_WH + w_W.cross(r_knee_link) + leg.length_rate_mps * u_W, u_W, w_W);
  }
  return momentum;
}

Vector3d AngularMomentum(const biped::BodyState& body, const biped::BipedParameters& biped) {
  const Vector3d inertia_kgm2(biped.body_inertia_roll_kgm2, biped.body_inertia_pitch_kgm2,
                              biped.body_inertia_yaw_kgm2);
  const Vector3d w_B = body.R_WB.transpose() * body.w_WB;
  return LegsMomentum(body, biped) + body.R_WB * inertia_kgm2.cwiseProduct(w_B) +
         biped.body_mass_kg * (body.p_WB - body.p_WC).cross(body.v_WB - body.v_WC);
}

namespace {

/// Widths of pits are compared with this to spare, m: a heading askew makes them wider.
constexpr double kWidthSlackM = 0.005;
/// Nearer to the edge a swing foot does not change its mind.
constexpr double kDecidedWithinM = 0.15;

bool IsNarrow(const PitGains& gains, const PitAhead& pit) {
  return pit.far_m - pit.near_m <= gains.walk_width_max_m + kWidthSlackM;
}

}  // namespace

std::optional<WalkPlan> StepAtPit(const Context& context, const GaitMemory& memory,
                                  const PitAhead& pit, const WalkAhead& walk, double natural_m) {
  const PitGains& gains = context.gains.pit;
  if (pit.far_m <= 0) {  // Behind the supporting foot: the next one does not go back.
    const double earliest_m = pit.far_m + gains.walk.far_margin_m;
    if (natural_m >= earliest_m) return std::nullopt;
    return WalkPlan{earliest_m, 0};
  }
  const double latest_m = pit.near_m - gains.walk.near_margin_m;
  const bool before = latest_m > gains.walk.stride_min_m;
  const bool goes_over = IsNarrow(gains, pit) && memory.speed.desired_mps > gains.walk_slowest_mps;
  if (!goes_over && before) {
    if (natural_m <= latest_m) return std::nullopt;
    return WalkPlan{latest_m, 1};
  }
  // Once the swing foot is at the pit its side is decided.
  const std::optional<PitAhead> from_swing_foot =
      PitFrom(memory, context.body.legs[1 - memory.support_leg].p_WF);
  const bool decided =
      memory.walking == WalkingPhase::kFall && from_swing_foot->near_m < kDecidedWithinM;
  const std::optional<int> strides = memory.walking_step.strides_to_pit;
  if (decided && !strides) return std::nullopt;
  return PlanWalkOverPit(walk, pit, gains.walk, strides, decided);
}

double SpeedBeforePit(const Context& context, const GaitMemory& memory) {
  constexpr double kFree = std::numeric_limits<double>::infinity();
  const std::optional<PitAhead> pit = PitFrom(memory, context.body.p_WC);
  const PitGains& gains = context.gains.pit;
  if (!pit || pit->far_m < 0) return kFree;
  const bool narrow = IsNarrow(gains, *pit);
  const double least_mps = narrow ? gains.walk_over_mps : 0;
  const double left_m =
      std::max(0.0, pit->near_m - (narrow ? gains.walk_slow_m : gains.walk_stop_m));
  return std::sqrt(least_mps * least_mps + 2 * gains.walk_stop_mps2 * left_m);
}

namespace {

/// A swing foot counts as landed only after this part of its swing: before, it drags.
constexpr double kLandsAfter = 0.6;
/// A foot that bounced off is waited for this long beyond the double support.
constexpr double kBounceS = 0.1;
/// The hip is led to a new ground height; a larger jump than this is taken as it is.
constexpr double kGroundJumpM = 0.4;

double SwingProgress(const Context& context, const GaitMemory& memory) {
  return std::clamp(context.TimeIn(memory) / SwingTime(context, memory), 0.0, 1.0);
}

/// Takes one step off the strides planned to a pit.
void CountStrideToPit(WalkingStep& step) {
  if (step.strides_to_pit && --*step.strides_to_pit < 0) step.strides_to_pit.reset();
}

void Enter(WalkingPhase phase, const Context& context, GaitMemory& memory) {
  const int swing_leg = 1 - memory.support_leg;
  switch (phase) {
    case WalkingPhase::kDoubleSupport:
      memory.support_leg = swing_leg;
      memory.phase_start_s = context.body.time_s;
      memory.walking_step.swing_time_s = CommandedSwingTime(context);
      memory.walking_step.landed_W_m = context.body.legs[swing_leg].p_WF;
      CountStep(context, memory);
      break;
    case WalkingPhase::kRise:
      memory.phase_start_s = context.body.time_s;
      memory.walking_step.swing_start_W_m = context.body.legs[swing_leg].p_WF;
      CountStrideToPit(memory.walking_step);
      LookForPit(context, memory);
      break;
    case WalkingPhase::kFall:  // The swing goes on: same clock.
      break;
  }
  memory.walking = phase;
}

/// Stepping and walking change into each other at once; what came from a jump to run walks first.
void ChooseGait(const Context& context, GaitMemory& memory) {
  const stream::Gait goal = context.goal.gait;
  if (!IsHopping(goal)) {
    memory.gait = goal;
    memory.transition.after_jump = false;
  } else if (memory.transition.after_jump && goal == stream::Gait::kRun) {
    memory.gait = stream::Gait::kWalk;
    memory.transition.after_jump = false;
  }
}

/// The ground height the hip goes by: the supporting foot's, from Fall on halfway to the next.
void FollowGround(const Context& context, GaitMemory& memory) {
  const double support_m = context.body.legs[memory.support_leg].p_WF.z();
  double wanted_m = support_m;
  if (memory.walking == WalkingPhase::kFall && context.seen_ground != nullptr) {
    wanted_m = (support_m + memory.foothold_W_m.z()) / 2;
  }
  if (std::fabs(memory.walking_step.support_height_m - wanted_m) > kGroundJumpM) {
    memory.walking_step.support_height_m = support_m;
  }
  const double change_m = context.gains.walking.support_rise_mps * context.step_s;
  memory.walking_step.support_height_m +=
      std::clamp(wanted_m - memory.walking_step.support_height_m, -change_m, change_m);
}

/// A swinging hip accelerates the COM, which moves a foreseen foothold, whose rate is torque of the
/// same hip: a loop without delay, and with a gain near one. A low pass smooths it.
void LeadFoot(const Context& context, const WalkingFoothold& foothold, GaitMemory& memory) {
  const bool smooths = context.TimeIn(memory) > 0 && foothold.foreseen;
  const double smooth_s = context.gains.style.landing_smooth_s;
  const double kept = smooths ? smooth_s / (smooth_s + context.step_s) : 0;
  memory.foothold_W_m = foothold.p_WF_m + kept * (memory.foothold_W_m - foothold.p_WF_m);
}

}  // namespace

WalkingCues SenseWalking(const Context& context, const GaitMemory& memory) {
  const double swing = SwingProgress(context, memory);
  const double loading_s = context.TimeIn(memory) - context.gains.walking.double_support_time_s;
  const bool loaded = context.body.legs[memory.support_leg].touching || loading_s > kBounceS;
  return {.double_support_over = loading_s >= 0 && loaded,
          .half_swing_over = swing > 0.5,
          .swing_foot_landed =
              swing > kLandsAfter && context.body.legs[1 - memory.support_leg].touching};
}

Targets AdvanceWalking(const Context& context, GaitMemory& memory) {
  ChooseGait(context, memory);
  const WalkingPhase next = Next(memory.walking, SenseWalking(context, memory));
  if (next != memory.walking) Enter(next, context, memory);
  FollowGround(context, memory);
  const double foresight = context.gains.style.foresight;
  const bool both = memory.walking == WalkingPhase::kDoubleSupport;
  // Without style nothing follows a foothold before its foot leaves the ground.
  if (both && !memory.style.there && foresight == 0) return WalkingTargets(context, memory);
  const WalkingFoothold foothold = PlanWalkingFoothold(context, memory);
  memory.style.excess_m = foothold.excess_m;
  if (both) {
    memory.phase_start_s -= foresight * foothold.hurry * context.step_s;
    return WalkingTargets(context, memory);
  }
  LeadFoot(context, foothold, memory);
  memory.walking_step.strides_to_pit = foothold.strides_to_pit;
  const bool swinging = context.TimeIn(memory) < SwingTime(context, memory);
  if (swinging) memory.phase_start_s -= foothold.hurry * context.step_s;
  if (BeginThrust(context, memory)) return {};
  return WalkingTargets(context, memory);
}

namespace {

/// The foot is over its place after this part of the swing; late, it comes down at this rate.
constexpr double kSwingArrives = 0.9;
constexpr double kLateDescentMps = 0.7;
/// A foot that bounced off is pressed down this far below where it touched.
constexpr double kLandingDepthM = 0.03;
/// Over seen ground: clearance over all that lies from 10 cm behind to 20 cm ahead of the foot.
constexpr double kSeenClearanceM = 0.06;
constexpr double kProbeSpacingM = 0.05;
constexpr int kProbesBehind = 2;
constexpr int kProbesAhead = 4;
constexpr double kProbeUntil = 0.93;
constexpr double kFullClearanceUntil = 0.85;

/// Length that keeps the hip at its height over the ground: touchdown length in Rise, and by the
/// same law the extension in Fall and of the rear leg in Double Support that the paper describes.
double SupportLength(const Context& context, const GaitMemory& memory, int leg) {
  const WalkingGains& gains = context.gains.walking;
  const biped::LegState& state = context.body.legs[leg];
  const double height_m = gains.hip_height_m - AnticipatedCrouch(context, memory) -
                          TowCrouch(context, memory) + HipRise(context, memory) +
                          memory.walking_step.support_height_m - state.p_WF.z();
  return std::clamp(height_m / std::max(0.5, -state.u_HF_W.z()), gains.leg_length_min_m,
                    gains.leg_length_max_m);
}

LegTarget Supporting(const Context& context, const GaitMemory& memory, int leg, double share) {
  const WalkingGains& gains = context.gains.walking;
  LegTarget target;
  target.task = LegTask::kSupport;
  target.axial.length_m = SupportLength(context, memory, leg);
  target.axial.follow_rate = true;
  target.axial.stiffness_n_per_m = gains.leg_stiffness_n_per_m;
  target.axial.damping_ns_per_m = gains.leg_damping_ns_per_m;
  target.axial.feed_forward_n = gains.supported_mass_kg * kStandardGravityMps2 *
                                std::max(0.3, -context.body.legs[leg].u_HF_W.z());
  target.axial.min_n = 0;
  target.axial.share = share;
  return target;
}

/// A foot that bounced off is held where it touched, and pressed down there.
LegTarget WalkingLanding(const Context& context, const GaitMemory& memory, int leg) {
  LegTarget target;
  target.task = LegTask::kPlace;
  target.r_HF_W_m = memory.walking_step.landed_W_m - context.body.legs[leg].p_WH;
  target.r_HF_W_m.z() -= kLandingDepthM;
  return target;
}

/// Double Support: the load goes over from the rear leg to the front one.
Targets DoubleSupport(const Context& context, const GaitMemory& memory) {
  const int front = memory.support_leg, rear = 1 - front;
  const double passed =
      std::clamp(context.TimeIn(memory) / context.gains.walking.double_support_time_s, 0.0, 1.0);
  const bool front_touches = context.body.legs[front].touching;
  const double front_share = !front_touches || passed > 0.5 ? 1 : 0.5 + passed;
  Targets targets;
  targets.legs[front] = front_touches ? Supporting(context, memory, front, front_share)
                                      : WalkingLanding(context, memory, front);
  if (context.body.legs[rear].touching) {
    targets.legs[rear] = Supporting(context, memory, rear, 1 - passed);
  }
  AddStyle(context, memory, targets);
  return targets;
}

/// Height above which the swing foot must stay over seen ground.
double ClearHeight(const Context& context, const GaitMemory& memory, int leg, double swing) {
  const Vector3d ahead_W = ToWorld(memory.heading_rad, {1, 0, 0});
  double highest_m = -INFINITY;
  for (int i = -kProbesBehind; i <= kProbesAhead; ++i) {
    const Vector3d p = context.body.legs[leg].p_WF + i * kProbeSpacingM * ahead_W;
    highest_m = std::max(highest_m, terrain::GroundHeight(*context.seen_ground, p.x(), p.y()));
  }
  const double fade = swing < kFullClearanceUntil ? 1 : (1 - swing) / (1 - kFullClearanceUntil);
  return highest_m + context.biped.foot_radius_m + kSeenClearanceM * std::max(0.0, fade);
}

/// The swing foot's path: smooth from where it left to the foothold, held short to clear the
/// ground.
Vector3d SwingFoot(const Context& context, const GaitMemory& memory, int leg) {
  const WalkingGains& gains = context.gains.walking;
  const double time_s = context.TimeIn(memory);
  const double swing_time_s = SwingTime(context, memory);
  const double swing = std::clamp(time_s / swing_time_s, 0.0, 1.0);
  const double way = std::clamp(time_s / (kSwingArrives * swing_time_s), 0.0, 1.0);
  const double smooth = way * way * (3 - 2 * way);
  Vector3d p = memory.walking_step.swing_start_W_m +
               smooth * (memory.foothold_W_m - memory.walking_step.swing_start_W_m);
  p.z() += gains.clearance_m * std::sin(kPi * swing);
  if (time_s > swing_time_s) {
    p.z() = memory.foothold_W_m.z() - kLateDescentMps * (time_s - swing_time_s);
  }
  if (context.seen_ground != nullptr && swing < kProbeUntil) {
    p.z() = std::max(p.z(), ClearHeight(context, memory, leg, swing));
  }
  return p;
}

/// A long stride's leg lags behind its target, which is further from the hip: with that length the
/// foot would scuff. Shortened to the target's height in the direction that the leg has.
Vector3d AtHeight(const Vector3d& r_HF_W_m, const biped::LegState& leg) {
  const double length_m = r_HF_W_m.z() / std::min(-0.5, leg.u_HF_W.z());
  return r_HF_W_m * std::min(1.0, length_m / r_HF_W_m.norm());
}

}  // namespace

Targets WalkingTargets(const Context& context, const GaitMemory& memory) {
  if (memory.walking == WalkingPhase::kDoubleSupport) return DoubleSupport(context, memory);
  const int swing_leg = 1 - memory.support_leg;
  Targets targets;
  targets.legs[memory.support_leg] = Supporting(context, memory, memory.support_leg, 1);
  targets.legs[swing_leg].task = LegTask::kPlace;
  const biped::LegState& swinging = context.body.legs[swing_leg];
  Vector3d& r_HF_W = targets.legs[swing_leg].r_HF_W_m;
  r_HF_W = SwingFoot(context, memory, swing_leg) - swinging.p_WH;
  if (memory.walking_step.strides_to_pit) r_HF_W = AtHeight(r_HF_W, swinging);
  AddStyle(context, memory, targets);
  return targets;
}

}  // namespace footing::gait
