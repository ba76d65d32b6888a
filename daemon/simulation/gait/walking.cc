#include "daemon/simulation/gait/walking.h"

#include <algorithm>
#include <cmath>

#include "daemon/simulation/gait/cadence.h"
#include "daemon/simulation/gait/foothold.h"
#include "daemon/simulation/gait/pit_sight.h"
#include "daemon/simulation/gait/touchdown.h"
#include "daemon/simulation/gait/transition.h"
#include "daemon/simulation/biped/ground.h"

namespace footing::gait {
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

/// What was planned for the last step, less that step.
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
  if (memory.walking == WalkingPhase::kDoubleSupport) return WalkingTargets(context, memory);

  const WalkingFoothold foothold = PlanWalkingFoothold(context, memory);
  memory.foothold_W_m = foothold.p_WF_m;
  memory.walking_step.strides_to_pit = foothold.strides_to_pit;
  const bool swinging = context.TimeIn(memory) < SwingTime(context, memory);
  if (swinging) memory.phase_start_s -= foothold.hurry * context.step_s;
  if (BeginThrust(context, memory)) return {};
  return WalkingTargets(context, memory);
}

}  // namespace footing::gait
