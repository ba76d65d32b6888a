#include "common/virtual/people/stick_body.h"

#include <algorithm>
#include <cmath>

#include "common/base/units.h"

namespace footing::users {
namespace {

using stream::Gait;

/// A thumb gets to a new place in about 0.2 s, and holds it with a slow tremor.
constexpr double kThumbS = 0.05;
constexpr double kTremorS = 0.3;
constexpr double kTremor = 0.02;
constexpr double kPressS = 0.12;
/// Radii at ease: inside and outside of the circle that the user was shown, at 0.6.
constexpr double kWalkNear = 0.36, kWalkFar = 0.52;
constexpr double kRunNear = 0.72, kRunFar = 1.0;
/// Sideways to turn, of directions 30 to 75 degrees from the front.
constexpr double kTurnRad = DegreesToRadians(52);

}  // namespace

StickBody::StickBody(const Style& style, std::uint64_t seed)
    : style_(style), random_(seed), bias_rad_(random_.Uniform(-0.12, 0.12)) {}

void StickBody::Advance(const Intention& wanted, double step_s) {
  const bool jumps = wanted.gait == Gait::kJump;
  if (jumps && !wanted_jump_) pressed_s_ = kPressS;
  wanted_jump_ = jumps;
  pressed_s_ -= step_s;
  gesture_ = jumps ? Gait::kJump : wanted.gait;
  // Who jumps goes on pushing forward.
  double radius = 0;
  if (wanted.gait == Gait::kWalk) radius = std::lerp(kWalkNear, kWalkFar, wanted.effort);
  if (wanted.gait == Gait::kRun) radius = std::lerp(kRunNear, kRunFar, wanted.effort);
  if (jumps) radius = std::hypot(right_.value, front_.value);
  const double side = wanted.turn_rad == 0 ? 0 : wanted.turn_rad > 0 ? -1 : 1;
  const double angle_rad = bias_rad_ * (1 - std::fabs(side)) + side * kTurnRad;
  tremor_ += -step_s / kTremorS * tremor_ +
             kTremor * style_.amplitude * std::sqrt(2 * step_s / kTremorS) * random_.Normal();
  right_.Advance(radius * std::sin(angle_rad), kThumbS, step_s);
  front_.Advance(radius * std::cos(angle_rad), kThumbS, step_s);
}

void StickBody::Feel(Felt& felt) const {
  const double right = right_.value + tremor_, front = front_.value + tremor_;
  const double beyond = std::max(1.0, std::hypot(right, front));  // The rim of the stick.
  felt.stick_x = right / beyond;
  felt.stick_y = front / beyond;
  felt.button_a = pressed_s_ > 0;
}

}  // namespace footing::users
