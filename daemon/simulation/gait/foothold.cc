#include "daemon/simulation/gait/foothold.h"

#include <algorithm>
#include <cmath>

#include "common/base/units.h"
#include "daemon/simulation/biped/ground.h"
#include "daemon/simulation/gait/controller.h"
#include "daemon/simulation/gait/rough.h"
#include "daemon/simulation/gait/targets.h"
#include "daemon/simulation/gait/transition.h"

namespace footing::gait {
namespace {

using Eigen::Vector3d;

/// A foot that would land nearer than this to the other's line, or wider than this, hurries.
constexpr double kSidewaysNearM = 0.05;
constexpr double kSidewaysWideM = 0.45;
constexpr double kBackwardLimitM = 0.7;
constexpr double kHurryPerMetre = 6;
/// A braking run's foot is at most this far ahead, by speed, s: a slower body loses all its speed
/// over a foot further ahead, and is left low on a slanting leg. The last one may be further.
constexpr double kBrakingReachS = 0.115;
constexpr double kLandingReachS = 0.18;
/// Between a step without a foreseen foothold and one with it, at least.
constexpr double kLeastRangeS = 1e-3;

struct Pendulum {
  double rate_radps;  ///< w = sqrt(g / h).
  Vector3d r_foot_to_capture_H;
};

Pendulum SupportPendulum(const Context& context, const GaitMemory& memory) {
  const biped::BodyState& body = context.body;
  const Vector3d r_FC_W = body.p_WC - body.legs[memory.support_leg].p_WF;
  const double rate = std::sqrt(kStandardGravityMps2 / std::clamp(r_FC_W.z(), 0.6, 1.1));
  // Half the double support still passes before the new foot carries.
  const double growth = std::exp(rate * 0.5 * context.gains.walking.double_support_time_s);
  const Vector3d r_balance_W = r_FC_W + TowOffset(memory, kStandardGravityMps2 / (rate * rate));
  const Vector3d capture_H =
      ToHeading(memory.heading_rad, r_balance_W) + ToHeading(memory.heading_rad, body.v_WC) / rate;
  return {rate, growth * capture_H};
}

/// Part of the time to touchdown that the foothold of the present step is foreseen: as far as
/// the walk is regular, which it is not before a pit or after a push (style.h); 0 in a quick step.
double AimsAhead(const Context& context, const GaitMemory& memory) {
  const StyleGains& gains = context.gains.style;
  const double range_s = std::max(kLeastRangeS, gains.landing_from_s - gains.landing_to_s);
  const double slow = (StepTime(context, memory) - gains.landing_to_s) / range_s;
  return gains.landing_lead * gains.foresight * memory.style.share * std::clamp(slow, 0.0, 1.0);
}

/// Where a foot is led that is to touch down nearly at rest: as the capture point moves away from
/// the supporting foot, towards where it will be. A leg that lands at rest takes no momentum from
/// the body, so it stands further ahead by the way that its lower link would have cost.
Vector3d Aimed(const Context& context, const GaitMemory& memory, const Pendulum& pendulum,
               double share) {
  if (share == 0) return pendulum.r_foot_to_capture_H;
  const double left_s = StepTime(context, memory) * (1 - StepPhase(context, memory));
  Vector3d aimed_H = std::exp(pendulum.rate_radps * share * left_s) * pendulum.r_foot_to_capture_H;
  aimed_H.x() += share * context.biped.link_mass_kg / context.biped.mass_kg() *
                 pendulum.r_foot_to_capture_H.x();
  return aimed_H;
}

}  // namespace

WalkingFoothold PlanWalkingFoothold(const Context& context, const GaitMemory& memory) {
  const WalkingGains& gains = context.gains.walking;
  const double side = -biped::Side(memory.support_leg);  // Side of the swing leg.
  const Pendulum pendulum = SupportPendulum(context, memory);
  const auto [rate, capture_H] = pendulum;
  const double step_time_s = StepTime(context, memory);
  const double growth = std::exp(rate * step_time_s);

  const double back_m = memory.speed.desired_mps * step_time_s / (growth - 1);
  const double aside_m = side * gains.step_width_m / (1 + growth);
  // The offset belongs to the coming step, which goes along the turned heading.
  const Vector3d offset_H = ToWorld(context.goal.turn_per_step_rad, Vector3d(-back_m, aside_m, 0));
  const double ahead = AimsAhead(context, memory);
  const Vector3d aimed_H = Aimed(context, memory, pendulum, ahead);
  const double natural_m = aimed_H.x() + offset_H.x() + memory.speed.integrators.walk_m;
  const double outward_m = side * (aimed_H.y() + offset_H.y());

  WalkingFoothold foothold;
  foothold.foreseen = ahead > 0;
  // The capture point moves away from the foot until touchdown.
  const double foreseen_s =
      context.gains.style.foresight * step_time_s * (1 - StepPhase(context, memory));
  const Vector3d landing_H = std::exp(rate * foreseen_s) * capture_H;
  const double landing_outward_m = side * (landing_H.y() + offset_H.y());
  foothold.excess_m = std::max(0.0, std::fabs(landing_H.x() - back_m) - gains.hurry_beyond_m) +
                      std::max(0.0, kSidewaysNearM - landing_outward_m) +
                      std::max(0.0, landing_outward_m - kSidewaysWideM);
  foothold.hurry = std::min(gains.hurry_rate, kHurryPerMetre * foothold.excess_m);

  const double y_m = side * std::clamp(SideStep(outward_m, context.gains.curve.leg_gap_m),
                                       -gains.feet_cross_m, gains.side_step_limit_m);
  const Vector3d& p_WF = context.body.legs[memory.support_leg].p_WF;
  double ahead_m = std::clamp(natural_m, -kBackwardLimitM, gains.step_length_limit_m);
  const Vector3d beside_W = p_WF + ToWorld(memory.heading_rad, {0, y_m, 0});
  if (const auto pit = PitFrom(memory, beside_W)) {
    const double left_s = std::max(0.0, SwingTime(context, memory) - context.TimeIn(memory));
    const double stride_m = memory.speed.desired_mps * step_time_s;
    const WalkAhead walk{std::exp(rate * left_s) * capture_H.x(), 1 / growth, stride_m};
    if (const auto plan = StepAtPit(context, memory, *pit, walk, ahead_m)) {
      ahead_m = plan->foothold_m;
      foothold.strides_to_pit = plan->strides;
    }
  }
  foothold.p_WF_m = p_WF + ToWorld(memory.heading_rad, {ahead_m, y_m, 0});
  if (context.seen_ground != nullptr) {
    foothold.p_WF_m.z() =
        context.biped.foot_radius_m +
        terrain::GroundHeight(*context.seen_ground, foothold.p_WF_m.x(), foothold.p_WF_m.y());
  }
  return foothold;
}

/// How far to the left the foot of a support goes that is to turn the velocity by a step's turn.
/// The leg's force points from the foot to the COM: for the mean sideways acceleration v turn /
/// T_step it must come from h v turn / (g T_step) on the curve's outer side. While the foot is down
/// the COM moves on along the mean of the old and the new direction, and so does the neutral point.
double TurningOffset(const Context& context, const GaitMemory& memory, double ahead_mps) {
  const double turn_rad = context.goal.turn_per_step_rad;
  const double lean_m = context.gains.hopping.touchdown_length_m * ahead_mps * turn_rad /
                        (kStandardGravityMps2 * memory.step_time_s);
  return ahead_mps * memory.hop.support_time_s / 2 * turn_rad / 2 - lean_m;
}

/// Pushed aside, a jump lands with spread legs: the leg on that side goes out, the other stays.
/// Both swinging out would turn the body over against them.
double SpreadShare(const RecoveryGains& gains, double aside_mps, int leg) {
  if (aside_mps * biped::Side(leg) > 0) return 1;
  return 1 - std::min(1.0, std::fabs(aside_mps) / gains.spread_mps);
}

Vector3d HoppingFoothold(const Context& context, const GaitMemory& memory, int leg) {
  const HoppingGains& gains = context.gains.hopping;
  const bool jumping = memory.gait == stream::Gait::kJump;
  const Vector3d v_H = ToHeading(memory.heading_rad, context.body.v_WC);
  const double faster_mps = std::clamp(v_H.x() - memory.speed.desired_mps, -gains.slower_limit_mps,
                                       gains.faster_limit_mps);
  const double learned_m =
      jumping ? memory.speed.integrators.jump_m
              : memory.speed.integrators.run_m + gains.speed_gain_s * memory.speed.desired_mps;
  const double velocity_gain_s = jumping ? gains.jump_velocity_gain_s : gains.run_velocity_gain_s;
  const bool brakes = LeavesRun(context, memory) && faster_mps > 0;
  const double gain_s = brakes ? context.gains.transition.leaving_run_gain_s : velocity_gain_s;
  double ahead_m = v_H.x() * memory.hop.support_time_s / 2 + gain_s * faster_mps + learned_m;

  const bool landing = memory.transition.preparing_landing && !jumping;
  if (landing) ahead_m += context.gains.transition.landing_reach_m;
  if (brakes) ahead_m = std::min(ahead_m, (landing ? kLandingReachS : kBrakingReachS) * v_H.x());
  ahead_m += memory.pit.shift_m + memory.ground.shift_m;
  const bool preparing = memory.transition.preparing_jump && !jumping;
  const double side_gain_s =
      preparing ? context.gains.transition.preparation_gain_s : velocity_gain_s;
  const double spacing_m = jumping     ? context.biped.hip_half_spacing_m
                           : preparing ? 0
                                       : gains.run_foot_spacing_m;
  double aside_m = v_H.y() * memory.hop.support_time_s / 2 + side_gain_s * v_H.y();
  if (jumping) aside_m *= SpreadShare(context.gains.recovery, v_H.y(), leg);
  const Vector3d tow_H =
      ToHeading(memory.heading_rad, TowOffset(memory, memory.pit.last_hop.touchdown_height_m));
  ahead_m += tow_H.x();
  // A tow that begins in flight would put the foot so far ahead that the body is too low for it.
  if (tow_H.x() > 0) {
    ahead_m = std::min(ahead_m, std::max(context.gains.tow.reach_m, kBrakingReachS * v_H.x()));
  }
  const double left_m =
      aside_m + biped::Side(leg) * spacing_m + TurningOffset(context, memory, v_H.x()) + tow_H.y();
  return ToWorld(
      memory.heading_rad,
      {std::clamp(ahead_m, -gains.foothold_limit_m, gains.foothold_limit_m),
       std::clamp(left_m, -gains.foothold_side_limit_m, gains.foothold_side_limit_m), 0});
}

Vector3d HipToFoot(const biped::BodyState& body, int leg, const Vector3d& offset_from_com_W_m,
                   double length_m) {
  constexpr double kSteepest = 0.8;  // Horizontal part of the leg's length, at most.
  Vector3d r = body.p_WC + offset_from_com_W_m - body.legs[leg].p_WH;
  r.z() = 0;
  const double level_m = std::min(r.norm(), kSteepest * length_m);
  if (r.norm() > 1e-9) r *= level_m / r.norm();
  r.z() = -std::sqrt(length_m * length_m - level_m * level_m);
  return r;
}

Vector3d Mirrored(double heading_rad, const Vector3d& other_r_HF_W_m, double length_m,
                  double aside_rad) {
  const Vector3d other_H = ToHeading(heading_rad, other_r_HF_W_m);
  const double pitch_rad = std::atan2(other_H.x(), -other_H.z());
  const double roll_rad = std::atan2(other_H.y(), -other_H.z()) - aside_rad;
  return ToWorld(heading_rad, length_m * Vector3d(-std::sin(pitch_rad), -std::sin(roll_rad),
                                                  -std::cos(pitch_rad) * std::cos(roll_rad)));
}

namespace {

constexpr double kShortestStepS = 0.12;
constexpr double kLongestStepS = 1.2;
constexpr int kStepsToSettle = 2;
constexpr double kSettledMps = 0.05;
constexpr double kLargestErrorMps = 0.8;
/// Running, and on a slope, speeding up takes longer than v_d does: that is not an error to learn
/// from, and the speed would overshoot by what was learned.
constexpr double kLargestErrorBehindMps = 0.3;

double StepGain(stream::Gait gait, const Gains& gains) {
  return IsHopping(gait) ? gains.hopping.run_speed_integral_s : gains.walking.speed_integral_s;
}

void Learn(double error_mps, const Gains& gains, GaitMemory& memory) {
  const double change_m = StepGain(memory.gait, gains) * error_mps;
  SpeedIntegrators& learned = memory.speed.integrators;
  switch (memory.gait) {
    case stream::Gait::kRun:
      learned.run_m = std::clamp(learned.run_m + change_m, -gains.hopping.run_integral_limit_m,
                                 gains.hopping.run_integral_limit_m);
      return;
    case stream::Gait::kJump:
      learned.jump_m = std::clamp(learned.jump_m + change_m, -gains.hopping.jump_integral_limit_m,
                                  gains.hopping.jump_integral_limit_m);
      return;
    case stream::Gait::kStep:
    case stream::Gait::kWalk:
      learned.walk_m = std::clamp(learned.walk_m + change_m, gains.walking.integral_min_m,
                                  gains.walking.integral_max_m);
      return;
    case stream::Gait::kUnspecified:
      return;
  }
}

}  // namespace

void CountStep(const Context& context, GaitMemory& memory) {
  const double made_heading_rad = memory.heading_rad;  // Heading of the step that ends here.
  memory.heading_rad += context.goal.turn_per_step_rad;
  ++memory.steps;
  LastStep& last = memory.last_step;
  if (last.gait != memory.gait) last.steps_in_gait = 0;
  last.gait = memory.gait;
  ++last.steps_in_gait;
  const double duration_s = context.body.time_s - last.time_s;
  if (last.known && duration_s > kShortestStepS && duration_s < kLongestStepS) {
    memory.step_time_s =
        last.steps_in_gait > 1 ? (memory.step_time_s + duration_s) / 2 : duration_s;
  }
  memory.turning_radps = context.goal.turn_per_step_rad / memory.step_time_s;
  if (last.known && duration_s > kShortestStepS && last.steps_in_gait > kStepsToSettle) {
    const Eigen::Vector3d v_H =
        ToHeading(made_heading_rad, context.body.p_WC - last.p_WC) / duration_s;
    const double error_mps = v_H.x() - memory.speed.desired_mps;
    const bool settled =
        std::fabs(memory.speed.target_mps - memory.speed.desired_mps) < kSettledMps;
    const bool lags = memory.gait == stream::Gait::kRun || memory.ground.slope != 0;
    const double largest_mps = lags ? kLargestErrorBehindMps : kLargestErrorMps;
    const bool at_pit = memory.walking_step.strides_to_pit.has_value();
    if (settled && !at_pit && std::fabs(error_mps) < largest_mps) {
      Learn(error_mps, context.gains, memory);
    }
  }
  last.known = true;
  last.time_s = context.body.time_s;
  last.p_WC = context.body.p_WC;
}

namespace {

/// The gap is asked for in full from this bank on.
constexpr double kFullBankRad = 0.1;
/// It is given up between this tilt of the body, which runs in curves do not reach, and twice that.
constexpr double kPushedRad = 0.15;
/// The same where the run goes straight ahead.
constexpr double kPushedStraightRad = 0.06;
/// In a curve the idle leg begins to turn outwards this much before the legs pass each other, at
/// about twice the run's speed: its servo follows late, and at 6 m/s they come from 14 cm to 7 cm
/// in 6 ms. Straight ahead, 4 of 384 runs of 6 m/s fell with that by pushes of 26 N s.
constexpr double kPassingLeadS = 0.015;
/// A leg that is less steep reaches no other.
constexpr double kSteepEnoughM = -0.2;

/// Where the line from a hip along `r_HF_m` is at a height.
Vector3d AtHeight(const Vector3d& hip_m, const Vector3d& r_HF_m, double height_m) {
  return hip_m + (height_m - hip_m.z()) / r_HF_m.z() * r_HF_m;
}

/// From 0 to 1: how much of a curve it is.
double InCurve(const Context& context, const GaitMemory& memory) {
  return std::min(1.0, std::fabs(BankAngle(memory, context.gains.attitude)) / kFullBankRad);
}

/// From 0 to 1: how much of the gap is asked for.
double Asked(const Context& context, const GaitMemory& memory) {
  const double tilt_rad = std::fabs(TiltAside(context.body, memory, context.gains.attitude));
  const auto upright = [tilt_rad](double pushed_rad) {
    return std::clamp(2 - tilt_rad / pushed_rad, 0.0, 1.0);
  };
  return std::max(InCurve(context, memory) * upright(kPushedRad), upright(kPushedStraightRad));
}

}  // namespace

double SideStep(double outward_m, double gap_m) {
  return std::max(outward_m, gap_m + 2 * std::min(0.0, outward_m));
}

void KeepLegsApart(const Context& context, const GaitMemory& memory, Targets& targets) {
  const double gap_m = context.gains.curve.leg_gap_m;
  const int leg = 1 - memory.support_leg;
  LegTarget& target = targets.legs[leg];
  if (gap_m <= 0 || memory.gait != stream::Gait::kRun || target.task != LegTask::kPlace) return;
  const double asked = Asked(context, memory);
  const biped::LegState &own = context.body.legs[leg], &other = context.body.legs[1 - leg];
  const Vector3d r_other_m = other.p_WF - other.p_WH;
  if (asked <= 0 || target.r_HF_W_m.z() > kSteepEnoughM || r_other_m.z() > kSteepEnoughM) return;

  // Both at the height of the upper foot; side by side they are nearest there.
  const double height_m = std::max(own.p_WH.z() + target.r_HF_W_m.z(), other.p_WF.z());
  const Vector3d feet_H =
      ToHeading(memory.heading_rad, AtHeight(own.p_WH, target.r_HF_W_m, height_m) -
                                        AtHeight(other.p_WH, r_other_m, height_m));
  const Vector3d hips_H = ToHeading(memory.heading_rad, own.p_WH - other.p_WH);
  const double side = biped::Side(leg);
  const double outward_m = side * feet_H.y(), hips_m = side * hips_H.y();
  if (outward_m >= gap_m) return;
  // Where they cross, how far are they apart fore and aft?
  const double way = outward_m < 0 && hips_m > 0 ? hips_m / (hips_m - outward_m) : 1;
  const double ahead_m = std::fabs(std::lerp(hips_H.x(), feet_H.x(), way));
  const double lead_s = kPassingLeadS * InCurve(context, memory);
  const double near_m = gap_m + lead_s * 2 * std::fabs(memory.speed.desired_mps);
  const double share = asked * std::clamp(2 - ahead_m / near_m, 0.0, 1.0);
  const double reach = target.r_HF_W_m.z() / (height_m - own.p_WH.z());
  const double length_m = target.r_HF_W_m.norm();
  target.r_HF_W_m +=
      ToWorld(memory.heading_rad, {0, side * share * reach * (gap_m - outward_m), 0});
  target.r_HF_W_m *= length_m / target.r_HF_W_m.norm();
}

double AnticipatedLean(const Context& context, const GaitMemory& memory) {
  const AnticipationGains& gains = context.gains.anticipation;
  const double missing_mps = context.goal.speed_mps - memory.speed.desired_mps;
  return std::clamp(gains.lean_rad_per_mps * missing_mps, -gains.lean_limit_rad,
                    gains.lean_limit_rad);
}

double AnticipatedCrouch(const Context& context, const GaitMemory& memory) {
  const bool waits = context.goal.gait == stream::Gait::kJump && !IsHopping(memory.gait);
  return waits ? context.gains.anticipation.crouch_m : 0;
}

double SwingTime(const Context& context, const GaitMemory& memory) {
  return memory.walking_step.swing_time_s > 0 ? memory.walking_step.swing_time_s
                                              : context.gains.walking.swing_time_s;
}

double StepTime(const Context& context, const GaitMemory& memory) {
  return SwingTime(context, memory) + context.gains.walking.double_support_time_s;
}

double StepPhase(const Context& context, const GaitMemory& memory) {
  const double double_support_s = context.gains.walking.double_support_time_s;
  const double time_s = memory.walking == WalkingPhase::kDoubleSupport
                            ? std::min(context.TimeIn(memory), double_support_s)
                            : double_support_s + context.TimeIn(memory);
  return std::clamp(time_s / StepTime(context, memory), 0.0, 1.0);
}

double CommandedSwingTime(const Context& context) {
  const WalkingGains& walking = context.gains.walking;
  const CadenceGains& limits = context.gains.cadence;
  if (!(context.goal.cadence_hz > 0)) return walking.swing_time_s;
  return std::clamp(1 / context.goal.cadence_hz - walking.double_support_time_s,
                    limits.swing_time_min_s,
                    std::max(limits.swing_time_max_s, walking.swing_time_s));
}

double RunLiftOffSpeed(const Context& context, const GaitMemory& memory) {
  const CadenceGains& limits = context.gains.cadence;
  if (!(context.goal.cadence_hz > 0)) return context.gains.hopping.run_lift_off_mps;
  const double flight_s = 1 / context.goal.cadence_hz - memory.hop.support_time_s;
  return std::clamp(kStandardGravityMps2 * flight_s / 2, limits.run_lift_off_min_mps,
                    limits.run_lift_off_max_mps);
}

}  // namespace footing::gait
