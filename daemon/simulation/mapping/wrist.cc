#include "daemon/simulation/mapping/wrist.h"

#include <cmath>
#include <optional>

namespace footing::mapping {
namespace {

using stream::Gait;

/// Steps in a period of the hands: walking's own two; users who run swing too fast for two.
constexpr double kWalkStepsPerSwing = 2;
constexpr double kRunStepsPerSwing = 1;

/// Mean over the hands for which it is valid.
std::optional<double> Mean(const WristFeatures& features, bool HandFeatures::*valid,
                           double HandFeatures::*value) {
  const bool left = features.left.*valid, right = features.right.*valid;
  if (left && right) return (features.left.*value + features.right.*value) / 2;
  if (left) return features.left.*value;
  if (right) return features.right.*value;
  return std::nullopt;
}

bool BothMove(const WristFeatures& features) {
  return features.left.present && features.right.present && features.left.moving &&
         features.right.moving;
}

}  // namespace

Gait WristInterface::GaitOf(double phase_rad, double frequency_hz) const {
  const bool jumped = command_.gait == Gait::kJump;
  const double border_rad =
      jumped ? mapping_.out_of_phase_above_rad
      : command_.gait == Gait::kStep
          ? (mapping_.in_phase_below_rad + mapping_.out_of_phase_above_rad) / 2
          : mapping_.in_phase_below_rad;
  if (std::fabs(phase_rad) < border_rad) return Gait::kJump;
  const double slack_hz = command_.gait == Gait::kRun    ? -mapping_.walk_run_hysteresis_hz
                          : command_.gait == Gait::kWalk ? mapping_.walk_run_hysteresis_hz
                                                         : 0;
  return frequency_hz < mapping_.walk_run_border_hz + slack_hz ? Gait::kWalk : Gait::kRun;
}

double WristInterface::TurnOf(const WristFeatures& features) const {
  const auto roll_rad = Mean(features, &HandFeatures::inclination_valid, &HandFeatures::roll_rad);
  if (!roll_rad) return command_.turn_per_step_rad;
  const double before = -command_.turn_per_step_rad;  // Positive: it was inclined to the right.
  const bool inclined = *roll_rad * before > 0;
  const double border_rad = inclined ? mapping_.straight_below_rad : mapping_.turn_above_rad;
  if (std::fabs(*roll_rad) <= border_rad) return 0;
  return *roll_rad > 0 ? -mapping_.turn_per_step_rad : mapping_.turn_per_step_rad;
}

biped::GaitCommand WristInterface::Rest() { return command_ = biped::GaitCommand{}; }

biped::GaitCommand WristInterface::Advance(double time_s, const WristFeatures& features) {
  const double turn_rad = TurnOf(features);
  if (!BothMove(features)) {
    Rest();
    valid_time_s_ = time_s;
    command_.turn_per_step_rad = turn_rad;
    return command_;
  }
  const auto frequency_hz =
      Mean(features, &HandFeatures::frequency_valid, &HandFeatures::frequency_hz);
  if (!features.phase_valid || !frequency_hz) {
    if (time_s - valid_time_s_ > mapping_.hold_s) Rest();
    return command_;
  }
  valid_time_s_ = time_s;
  command_.gait = GaitOf(features.phase_rad, *frequency_hz);
  command_.turn_per_step_rad = turn_rad;
  switch (command_.gait) {
    case Gait::kWalk:
      command_.speed_mps = mapping_.walk_mps_from_hz(*frequency_hz);
      command_.cadence_hz = kWalkStepsPerSwing * *frequency_hz;
      break;
    case Gait::kRun:
      command_.speed_mps = mapping_.run_mps_from_hz(*frequency_hz);
      command_.cadence_hz = kRunStepsPerSwing * *frequency_hz;
      break;
    case Gait::kJump:
      command_.speed_mps = mapping_.jump_mps_from_hz(*frequency_hz);
      if (const auto amplitude_mps2 =
              Mean(features, &HandFeatures::amplitude_valid, &HandFeatures::amplitude_mps2)) {
        command_.height_m = mapping_.jump_m_from_mps2(*amplitude_mps2);
      }
      break;
    case Gait::kStep:
    case Gait::kUnspecified:
      break;
  }
  return command_;
}

}  // namespace footing::mapping
