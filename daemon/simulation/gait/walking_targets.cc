#include <algorithm>
#include <cmath>

#include "common/base/units.h"
#include "daemon/simulation/gait/anticipation.h"
#include "daemon/simulation/gait/cadence.h"
#include "daemon/simulation/gait/frames.h"
#include "daemon/simulation/gait/walking.h"
#include "daemon/simulation/biped/ground.h"

namespace footing::gait {
namespace {

using Eigen::Vector3d;

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
  const double height_m = gains.hip_height_m - AnticipatedCrouch(context, memory) +
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
  return targets;
}

}  // namespace footing::gait
