#include "daemon/simulation/gait/foothold.h"

#include <algorithm>
#include <cmath>

#include "common/base/units.h"
#include "daemon/simulation/gait/cadence.h"
#include "daemon/simulation/gait/frames.h"
#include "daemon/simulation/gait/leg_room.h"
#include "daemon/simulation/gait/pit_sight.h"
#include "daemon/simulation/gait/transition.h"
#include "daemon/simulation/gait/walk_sight.h"
#include "daemon/simulation/biped/ground.h"

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
  const Vector3d capture_H =
      ToHeading(memory.heading_rad, r_FC_W) + ToHeading(memory.heading_rad, body.v_WC) / rate;
  return {rate, growth * capture_H};
}

}  // namespace

WalkingFoothold PlanWalkingFoothold(const Context& context, const GaitMemory& memory) {
  const WalkingGains& gains = context.gains.walking;
  const double side = -biped::Side(memory.support_leg);  // Of the swing leg.
  const auto [rate, capture_H] = SupportPendulum(context, memory);
  const double step_time_s = SwingTime(context, memory) + gains.double_support_time_s;
  const double growth = std::exp(rate * step_time_s);

  const double back_m = memory.speed.desired_mps * step_time_s / (growth - 1);
  const double aside_m = side * gains.step_width_m / (1 + growth);
  // The offset belongs to the coming step, which goes along the turned heading.
  const Vector3d offset_H = ToWorld(context.goal.turn_per_step_rad, Vector3d(-back_m, aside_m, 0));
  const double natural_m = capture_H.x() + offset_H.x() + memory.speed.integrators.walk_m;
  const double outward_m = side * (capture_H.y() + offset_H.y());

  WalkingFoothold foothold;
  const double excess_m = std::max(0.0, std::fabs(capture_H.x() - back_m) - gains.hurry_beyond_m) +
                          std::max(0.0, kSidewaysNearM - outward_m) +
                          std::max(0.0, outward_m - kSidewaysWideM);
  foothold.hurry = std::min(gains.hurry_rate, kHurryPerMetre * excess_m);

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
  const double left_m =
      aside_m + biped::Side(leg) * spacing_m + TurningOffset(context, memory, v_H.x());
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

}  // namespace footing::gait
