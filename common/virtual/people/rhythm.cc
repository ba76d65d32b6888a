#include "common/virtual/people/rhythm.h"

#include <algorithm>
#include <cmath>

#include "common/base/units.h"

namespace footing::users {
namespace {

/// How fast people change tempo, the relation of two limbs, and start or stop a swing.
constexpr double kTempoS = 0.12;
constexpr double kPhaseS = 0.1;
constexpr double kAmplitudeS = 0.08;
/// Correlation time of the drift of the tempo.
constexpr double kDriftS = 6;

}  // namespace

void Follower::Advance(double target, double time_constant_s, double step_s) {
  const double w = 1 / time_constant_s;
  rate += step_s * (w * w * (target - value) - 2 * w * rate);
  value += step_s * rate;
}

void Rhythm::Advance(const Aim& aim, double step_s) {
  drift_ += -step_s / kDriftS * drift_ +
            style_.tempo_drift * std::sqrt(2 * step_s / kDriftS) * random_.Normal();
  const double tempo = style_.tempo * (1 + std::clamp(drift_, -0.12, 0.12));
  const bool resting = activity_.value < 0.05 && activity_.rate <= 0;
  if (aim.moves) {
    const double phase = aim.together ? 0 : 0.5 + style_.phase_error_rad / (2 * kPi);
    if (resting) {  // Limbs at rest begin as they are meant to go on.
      frequency_ = {aim.frequency_hz * tempo, 0};
      phase_ = {phase, 0};
      cycles_ = std::ceil(cycles_);
    }
    frequency_.Advance(aim.frequency_hz * tempo, kTempoS, step_s);
    phase_.Advance(phase, kPhaseS, step_s);
  }
  const double amplitude = aim.moves ? aim.amplitude * style_.amplitude : 0;
  amplitude_.Advance(amplitude, kAmplitudeS, step_s);
  activity_.Advance(aim.moves ? 1 : 0, kAmplitudeS, step_s);
  cycles_ += activity_.value * frequency_.value * step_s;  // The first cycle begins gently.
}

}  // namespace footing::users
