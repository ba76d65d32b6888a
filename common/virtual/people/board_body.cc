#include "common/virtual/people/board_body.h"

#include <algorithm>
#include <cmath>

#include "common/base/units.h"

namespace footing::users {
namespace {

using stream::Gait;

/// Ordinary frequencies of one foot, Hz. People were shown that a jog, faster than 1.2 Hz, runs.
constexpr double kWalkSlowHz = 0.55, kWalkFastHz = 0.95, kRunSlowHz = 1.5, kRunFastHz = 2.0;
/// Feet stand in the middle of their boards (their layout one_foot_each).
constexpr double kStanceM = 0.336;
constexpr double kLeanM = 0.05;
constexpr double kLeanS = 0.12;
/// Part of a cycle in which the load goes over from one foot to the other, walking and running.
constexpr double kWalkOver = 0.12, kRunOver = 0.06;
/// Shares of weight by which a step, and a jogging step, accelerate the body up and down.
constexpr double kBoardStepBounce = 0.12, kBoardJogBounce = 0.45;
/// A jump's gesture: both feet stand, then the heels rise, stay up and come down again, s.
constexpr double kStandsS = 0.42, kRisesS = 0.3, kStaysS = 0.1;
constexpr double kGestureS = kStandsS + 2 * kRisesS + kStaysS;
/// Again when it was in vain.
constexpr double kAgainS = 2.2;
/// How far heels rise, and the COP moves from the middle of the foot to the toes.
constexpr double kHeelRiseM = 0.07, kToesM = 0.085;
constexpr double kToesS = 0.05;
/// Slow sway of standing people, standard deviation and correlation time.
constexpr double kSwayM = 0.004, kSwayS = 1;

/// Second derivative of the smoothest way from 0 to 1 in unit time (minimum jerk: Flash & Hogan
/// 1985).
double MinimumJerkAcceleration(double u) {
  return u <= 0 || u >= 1 ? 0 : 60 * u - 180 * u * u + 120 * u * u * u;
}

}  // namespace

BoardBody::BoardBody(const Style& style, std::uint64_t seed)
    : style_(style), random_(seed), rhythm_(style, seed + 1) {}

/// The heels' acceleration, and where the pressure goes.
void BoardBody::Rise(double step_s) {
  const double h_m = kHeelRiseM * rise_size_ * style_.amplitude / (kRisesS * kRisesS);
  const double into_s = rises_s_ - kStandsS;
  const double down_s = into_s - kRisesS - kStaysS;
  lift_mps2_ =
      h_m * (MinimumJerkAcceleration(into_s / kRisesS) - MinimumJerkAcceleration(down_s / kRisesS));
  const bool up = rises_s_ >= 0 && into_s > -0.05 && down_s < 0.5 * kRisesS;
  toes_m_.Advance(up ? kToesM : 0, kToesS, step_s);
}

void BoardBody::Advance(const Intention& wanted, double step_s) {
  const bool jumps = wanted.gait == Gait::kJump;
  if (rises_s_ >= 0) rises_s_ += step_s;
  if (jumps && rises_s_ < 0) rises_s_ = 0;
  if (rises_s_ > (jumps ? kAgainS : kGestureS)) rises_s_ = jumps ? 0 : -1;
  const bool rising = rises_s_ >= 0 && rises_s_ < kGestureS;
  if (rises_s_ == 0) rise_size_ = wanted.size;
  // A rise that was begun is finished; after it the person walks on.
  gesture_ = rising  ? (rises_s_ < kStandsS ? Gait::kStep : Gait::kJump)
             : jumps ? Gait::kWalk
                     : wanted.gait;
  const bool runs = gesture_ == Gait::kRun, walks = gesture_ == Gait::kWalk;
  const double effort = wanted.effort;
  rhythm_.Advance({.moves = runs || walks,
                   .frequency_hz = runs ? std::lerp(kRunSlowHz, kRunFastHz, effort)
                                        : std::lerp(kWalkSlowHz, kWalkFastHz, effort)},
                  step_s);
  const double side = rising || wanted.turn_rad == 0 ? 0 : wanted.turn_rad > 0 ? -1 : 1;
  const bool stands = !runs && !walks;
  lean_m_.Advance(side * (stands ? 1.5 : 1) * kLeanM * style_.amplitude, kLeanS, step_s);
  run_.Advance(runs ? 1 : 0, kLeanS, step_s);
  sway_m_ +=
      -step_s / kSwayS * sway_m_ + kSwayM * std::sqrt(2 * step_s / kSwayS) * random_.Normal();
  Rise(step_s);
}

/// Share of the load on the right foot. Over a cycle the mean COP is under the COM, so who leans to
/// a side stands on it for longer.
double BoardBody::RightShare() const {
  const double lean = std::clamp(2 * lean_m_.value / kStanceM, -0.8, 0.8);
  const double standing = 0.5 + lean / 2;
  const double cycles = rhythm_.left_cycles();
  const double into = cycles - std::floor(cycles);
  const double border = 0.5 * (1 + lean + style_.asymmetry / 2);
  const double edge = std::min(into, std::min(std::fabs(into - border), 1 - into));
  const double over = std::lerp(kWalkOver, kRunOver, run_.value) / 2;
  const double away = std::clamp(edge / over, 0.0, 1.0);
  const double stepping = 0.5 + (into < border ? 0.5 : -0.5) * away;
  return std::lerp(standing, stepping, std::clamp(rhythm_.activity(), 0.0, 1.0));
}

double BoardBody::Load(double bounce_mps2) const {
  return std::max(0.0, style_.mass_kg * (kStandardGravityMps2 + bounce_mps2));
}

void BoardBody::Feel(Felt& felt) const {
  const double share =
      std::lerp(kBoardStepBounce, kBoardJogBounce, run_.value) * rhythm_.activity();
  const double bounce_mps2 =
      share * kStandardGravityMps2 * -std::cos(4 * kPi * rhythm_.left_cycles()) + lift_mps2_;
  const double load_n = Load(bounce_mps2);
  const double right = RightShare();
  const double forward_m = sway_m_ + toes_m_.value;
  felt.feet[0] = {(1 - right) * load_n, {forward_m, kStanceM / 2}};
  felt.feet[1] = {right * load_n, {forward_m, -kStanceM / 2}};
}

}  // namespace footing::users
