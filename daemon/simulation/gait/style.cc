#include "daemon/simulation/gait/style.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "common/base/units.h"
#include "daemon/simulation/biped/body_state.h"
#include "daemon/simulation/biped/ground.h"
#include "daemon/simulation/gait/foothold.h"
#include "daemon/simulation/gait/rough.h"
#include "daemon/simulation/gait/running.h"
#include "daemon/simulation/gait/targets.h"

namespace footing::gait {

using Eigen::Vector3d;

double HipRise(const Context& context, const GaitMemory& memory) {
  const double step_m = memory.speed.desired_mps * StepTime(context, memory);
  const double arc_m =
      context.gains.style.bob_share * step_m * step_m / (8 * context.gains.walking.hip_height_m);
  return -arc_m / 2 * std::cos(2 * kPi * StepPhase(context, memory));
}

void AddStyle(const Context& context, const GaitMemory& memory, Targets& targets) {
  const StyleGains& gains = context.gains.style;
  const double phase = StepPhase(context, memory);
  const double turn_radps = phase < 1 ? kPi / StepTime(context, memory) : 0;
  const double side = biped::Side(memory.support_leg);
  const double stride_rad = kPi * phase;
  const double roll_rad = stride_rad + kPi * gains.pelvis_roll_lead;
  const double roll_amplitude_rad = side * gains.pelvis_roll_rad;
  const double yaw_amplitude_rad = side * gains.pelvis_yaw_rad;
  const double bank_rad = -gains.turn_bank_share * memory.speed.desired_mps * memory.turning_radps /
                          kStandardGravityMps2;
  targets.lean_rad =
      gains.nod_rad * std::cos(2 * stride_rad) + gains.lean_rad_per_mps * memory.speed.desired_mps;
  targets.roll_rad = roll_amplitude_rad * std::sin(roll_rad) + bank_rad;
  targets.yaw_rad = -yaw_amplitude_rad * std::cos(stride_rad);
  targets.rate_W_radps = ToWorld(
      memory.heading_rad, turn_radps * Vector3d(roll_amplitude_rad * std::cos(roll_rad),
                                                -2 * gains.nod_rad * std::sin(2 * stride_rad),
                                                yaw_amplitude_rad * std::sin(stride_rad)));
}

namespace {

bool ChangesGait(const Context& context, const GaitMemory& memory) {
  const GaitTransition& change = memory.transition;
  return context.goal.gait != memory.gait || change.thrusting || change.absorbing ||
         change.preparing_landing || change.preparing_jump || change.after_jump;
}

/// Whether the ground within sight is at about one height.
bool IsLevelGround(const Context& context, const GaitMemory& memory) {
  if (context.seen_ground == nullptr) return true;
  const FadeGains& gains = context.gains.fade;
  const Vector3d& p_WC = context.body.p_WC;
  const double ahead_m = gains.sight_m + gains.sight_s * std::max(0.0, memory.speed.desired_mps);
  const auto height_m = [&](double along_m) {
    const Vector3d p_W = p_WC + ToWorld(memory.heading_rad, {along_m, 0, 0});
    return terrain::GroundHeight(*context.seen_ground, p_W.x(), p_W.y());
  };
  const double here_m = height_m(0);
  for (const double along_m : {-gains.sight_m, ahead_m / 3, 2 * ahead_m / 3, ahead_m}) {
    if (std::fabs(height_m(along_m) - here_m) > gains.level_m) return false;
  }
  return true;
}

}  // namespace

bool IsRegular(const Context& context, const GaitMemory& memory) {
  const FadeGains& gains = context.gains.fade;
  if (context.body.R_WB(2, 2) < std::cos(gains.tilt_rad)) return false;
  if (!IsHopping(memory.gait)) return memory.style.excess_m < gains.excess_m;
  const bool flies = memory.running == RunningPhase::kUpwardFlight ||
                     memory.running == RunningPhase::kDownwardFlight;
  if (!flies) return true;
  const Vector3d v_H = ToHeading(memory.heading_rad, context.body.v_WC);
  return std::fabs(v_H.x() - memory.speed.desired_mps) < gains.speed_error_mps &&
         std::fabs(v_H.y()) < gains.aside_mps;
}

double RegularShare(const Context& context, const GaitMemory& memory) {
  if (ChangesGait(context, memory) || memory.pit.sighting.ahead) return 0;
  if (IsSlippery(context) || !memory.tow.offset_W.isZero(0)) return 0;
  if (!IsRegular(context, memory) || !IsLevelGround(context, memory)) return 0;
  const FadeGains& gains = context.gains.fade;
  const double turn_rad = std::fabs(context.goal.turn_per_step_rad);
  return std::clamp((gains.turn_to_rad - turn_rad) / (gains.turn_to_rad - gains.turn_from_rad), 0.0,
                    1.0);
}

void FadeStyle(const Context& context, GaitMemory& memory) {
  StyleMemory& style = memory.style;
  if (!style.there) return;
  if (IsHopping(style.gait) != IsHopping(memory.gait)) style.share = 0;
  style.gait = memory.gait;
  const double before = style.share;
  // Looking at the ground takes time: without style, once in some steps is enough.
  constexpr std::int64_t kLooksEvery = 20;
  const bool sees = context.seen_ground != nullptr;
  if (sees && before == 0 &&
      std::llround(context.body.time_s / context.step_s) % kLooksEvery != 0) {
    return;
  }
  const double wanted = RegularShare(context, memory);
  const FadeGains& gains = context.gains.fade;
  style.share = std::clamp(wanted, before - context.step_s / gains.out_s,
                           before + context.step_s / gains.in_s);
  if (style.share >= before || IsHopping(memory.gait)) return;
  WalkingStep& step = memory.walking_step;
  const double swing_s = SwingTime(context, memory);
  const double shorter_s = std::min(swing_s, CommandedSwingTime(context));
  if (memory.walking != WalkingPhase::kDoubleSupport && context.TimeIn(memory) < swing_s) {
    memory.phase_start_s = context.body.time_s - context.TimeIn(memory) * shorter_s / swing_s;
  }
  step.swing_time_s = shorter_s;
}

}  // namespace footing::gait
