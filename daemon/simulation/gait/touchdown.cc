#include "daemon/simulation/gait/touchdown.h"

#include <algorithm>
#include <cmath>

#include "daemon/simulation/gait/frames.h"

namespace footing::gait {
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
  const double made_heading_rad = memory.heading_rad;  // Of the step that ends here.
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

}  // namespace footing::gait
