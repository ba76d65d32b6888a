#include "daemon/simulation/gait/pit_sight.h"

#include <algorithm>
#include <cmath>

#include "common/base/units.h"
#include "daemon/simulation/gait/foothold.h"
#include "daemon/simulation/gait/frames.h"

namespace footing::gait {
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

/// What the COM rises until lift-off grows with the spring's extension; the rest is learned.
constexpr double kRiseShare = 0.87;
/// A plan this near to the nominal lift-off leaves it as it is.
constexpr double kAsEverMps = 0.03;
/// Of a new measure in the remembered one.
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
          .loss_share = memory.pit.last_hop.loss_share};
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
  const bool as_ever = std::fabs(plan.lift_off_mps - nominal_mps) < kAsEverMps;
  if (seen.planned && !as_ever && (!plan.leaps || seen.leaping))
    seen.lift_off_mps = plan.lift_off_mps;
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

}  // namespace footing::gait
