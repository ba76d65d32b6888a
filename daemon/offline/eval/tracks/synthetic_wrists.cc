#include "daemon/offline/eval/tracks/synthetic_wrists.h"

#include <algorithm>
#include <cmath>

#include "common/units/units.h"

namespace footing::eval {
namespace {

using stream::Gait;

/// Time constants with which a person's hands go over to another swing, s.
constexpr double kSwingChangesS = 0.1;
constexpr double kTiltChangesS = 0.08;
/// Swings of walking and running, and tilt to steer: clearly beyond the mapping's borders.
constexpr double kEverydayMps2 = 10;
constexpr double kTiltBeyond = 1.5;

double From(const mapping::Scaling& scaling, double to) {
  const double part = (to - scaling.to_min) / std::max(1e-9, scaling.to_max - scaling.to_min);
  return std::lerp(scaling.from_min, scaling.from_max, std::clamp(part, 0.0, 1.0));
}

void Approach(double to, double time_constant_s, double& value) {
  value += (to - value) * (1 - std::exp(-SyntheticWrists::kReadingS / time_constant_s));
}

}  // namespace

SyntheticWrists::SyntheticWrists(const mapping::WristMapping& mapping, std::uint64_t seed)
    : mapping_(mapping), chain_(true), random_(seed) {
  shape_.direction_S.normalize();
}

SyntheticWrists::Swing SyntheticWrists::For(const biped::GaitCommand& wanted) const {
  Swing swing = now_;
  swing.phase_rad = wanted.gait == Gait::kJump ? 0 : kPi;
  swing.amplitude_mps2 = kEverydayMps2;
  const double turn = wanted.turn_per_step_rad;
  swing.roll_rad = turn == 0 ? 0 : -std::copysign(kTiltBeyond * mapping_.turn.turn_above, turn);
  switch (wanted.gait) {
    case Gait::kWalk:
      swing.frequency_hz = From(mapping_.swing.walk_mps_from_hz, wanted.speed_mps);
      break;
    case Gait::kRun:
      swing.frequency_hz = From(mapping_.swing.run_mps_from_hz, wanted.speed_mps);
      break;
    case Gait::kJump:
      swing.frequency_hz = From(mapping_.swing.jump_mps_from_hz, wanted.speed_mps);
      swing.amplitude_mps2 = From(mapping_.swing.jump_m_from_mps2, wanted.height_m);
      break;
    case Gait::kStep:
    case Gait::kUnspecified:
      swing.amplitude_mps2 = 0;
      break;
  }
  return swing;
}

Eigen::Vector3d SyntheticWrists::SpecificForce(double angle_rad) const {
  return wrists::InclinedGravity(now_.roll_rad, 0) +
         now_.amplitude_mps2 * std::sin(angle_rad) * shape_.direction_S;
}

mapping::Inputs SyntheticWrists::Advance(const biped::GaitCommand& wanted) {
  const Swing to = For(wanted);
  Approach(to.frequency_hz, kSwingChangesS, now_.frequency_hz);
  Approach(to.phase_rad, kSwingChangesS, now_.phase_rad);
  Approach(to.amplitude_mps2, kSwingChangesS, now_.amplitude_mps2);
  Approach(to.roll_rad, kTiltChangesS, now_.roll_rad);
  angle_rad_ = WrapAngle(angle_rad_ + 2 * kPi * now_.frequency_hz * kReadingS);
  const std::int64_t now_ns = SecondsToNanoseconds(static_cast<double>(++readings_) * kReadingS);
  const auto left = wrists::Read(sensor_, SpecificForce(angle_rad_), random_);
  const auto right = wrists::Read(sensor_, SpecificForce(angle_rad_ + now_.phase_rad), random_);
  chain_.Add(kLeftDevice, now_ns, left.specific_force_mps2, left.clipped_axes);
  chain_.Add(kRightDevice, now_ns, right.specific_force_mps2, right.clipped_axes);
  mapping::Inputs inputs;
  mapping::TakeFeatures(chain_.Compute(now_ns), 0, inputs);
  return inputs;
}

}  // namespace footing::eval
