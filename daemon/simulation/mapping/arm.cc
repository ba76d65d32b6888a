#include "daemon/simulation/mapping/arm.h"

#include <algorithm>
#include <cmath>

#include "common/base/units.h"

namespace footing::mapping {
namespace {

/// A rest is taken in parts of this length, each once the next one is over as well: while a motion
/// begins, the features call it a rest for a moment.
constexpr double kBlockS = 0.2;
/// It counts as much as strides of this time.
constexpr double kRestWeightS = 1;
/// Strides count once they are a whole cycle, and this time at least.
constexpr double kLeastS = 0.6;
/// The neutral is a mean over so much of the past.
constexpr double kHorizonS = 30;
/// Nearer to the neutral than this the arms are not twisted: a third of where a turn begins, since
/// between two turns to one side the mean of a cycle stays on that side.
constexpr double kNearRad = DegreesToRadians(8);
/// Longer gaps between readings do not count.
constexpr double kGapS = 0.1;

}  // namespace

void NeutralGrip::Hang(double time_s, double rotation_rad) {
  striding_ = false;
  if (!hanging_) {
    block_ = {.from_s = time_s};
    earlier_rad_.reset();
    rest_rad_.reset();
    hanging_ = true;
  }
  block_.sum_rad += rotation_rad;
  ++block_.count;
  if (time_s - block_.from_s < kBlockS) return;
  rest_rad_ = earlier_rad_;
  earlier_rad_ = block_.sum_rad / block_.count;
  block_ = {.from_s = time_s};
  if (!strode_) LearnFromRest();
}

void NeutralGrip::LearnFromRest() {
  if (!rest_rad_) return;
  neutral_rad_ = *rest_rad_;
  known_ = true;
  seen_s_ = kRestWeightS;
}

void NeutralGrip::Renew() {
  strode_ = known_ = false;
  seen_s_ = 0;
  if (hanging_) LearnFromRest();
}

void NeutralGrip::Stride(double time_s, double rotation_rad, double frequency_hz) {
  const double elapsed_s = striding_ ? std::clamp(time_s - time_s_, 0.0, kGapS) : 0;
  striding_ = true;
  hanging_ = false;
  strode_ = known_;
  time_s_ = time_s;
  if (known_ && std::fabs(rotation_rad - neutral_rad_) > kNearRad) return;
  seen_s_ = std::min(seen_s_ + elapsed_s, kHorizonS);
  const double share = seen_s_ > 0 ? elapsed_s / seen_s_ : 1;
  neutral_rad_ += share * (rotation_rad - neutral_rad_);
  known_ = known_ || (frequency_hz > 0 && seen_s_ >= std::max(kLeastS, 1 / frequency_hz));
}

void NeutralGrip::Rest() {
  striding_ = hanging_ = false;
  if (!known_) Forget();
}

std::optional<double> NeutralGrip::TwistOf(double rotation_rad) const {
  if (!known_) return std::nullopt;
  return rotation_rad - neutral_rad_;
}

namespace {

using stream::DeviceRole;

/// A hand whose controller was missing for this long may hold it otherwise.
constexpr double kForgetS = 5;
/// Cosine of the elevation from which an inclination shows a forearm's rotation about itself.
constexpr double kLeastLevel = 0.15;

std::optional<double> MeanElevation(const LimbPair& hands) {
  const auto left_rad = ForearmElevation(hands.left), right_rad = ForearmElevation(hands.right);
  if (!left_rad || !right_rad) return std::nullopt;
  return (*left_rad + *right_rad) / 2;
}

/// Mean of both hands.
std::optional<double> MeanRotation(const LimbPair& hands, bool by_swing) {
  const auto left_rad = ForearmRotation(hands.left, by_swing),
             right_rad = ForearmRotation(hands.right, by_swing);
  if (!left_rad || !right_rad) return std::nullopt;
  return (*left_rad + *right_rad) / 2;
}

/// Roll of arms that hang still: they show no twist, but one that is held aside.
std::optional<double> MeanRoll(const LimbPair& hands) {
  if (!hands.left.inclination_valid || !hands.right.inclination_valid) return std::nullopt;
  return (hands.left.roll_rad + hands.right.roll_rad) / 2;
}

}  // namespace

Result<ArmMapping> ParseArmMapping(const std::string& text, const std::string& origin) {
  ArmMapping mapping;
  TableFields fields;
  AddFields(mapping.swing, fields);
  fields.push_back({"bent_above_deg", &mapping.bent_above_rad, -90, 0, Unit::kDegrees});
  fields.push_back(
      {"straight_arm_below_deg", &mapping.straight_arm_below_rad, -90, 0, Unit::kDegrees});
  AddFields(mapping.turn, false, fields);
  if (const auto read = ReadTable(text, origin, fields); !read) return read.error();
  if (!mapping.swing.IsOrdered() || !mapping.turn.IsOrdered() ||
      mapping.straight_arm_below_rad > mapping.bent_above_rad) {
    return NotOrdered(origin);
  }
  return mapping;
}

std::optional<double> ForearmElevation(const LimbFeatures& hand) {
  if (!hand.inclination_valid) return std::nullopt;
  if (!hand.mounted) return hand.pitch_rad;
  const double across = std::hypot(std::sin(hand.roll_rad), std::sin(hand.pitch_rad));
  return -std::acos(std::min(1.0, across));
}

std::optional<double> ForearmRotation(const LimbFeatures& hand, bool by_swing) {
  if (by_swing) return hand.swing_valid ? std::optional(hand.swing_rad) : std::nullopt;
  if (!hand.inclination_valid) return std::nullopt;
  if (hand.mounted) return hand.roll_rad;
  if (hand.axial_valid) return hand.axial_rad;
  // Earlier versions of footingd send no axial angle. In a run this one is half as much again.
  const double level = std::cos(hand.pitch_rad);
  if (level < kLeastLevel) return std::nullopt;
  return std::asin(std::clamp(std::sin(hand.roll_rad) / level, -1.0, 1.0));
}

std::optional<double> ArmInterface::TurnRight(double time_s, const LimbPair& hands) {
  const bool swing = hands.left.moving && hands.right.moving;
  const bool hang = !swing && !bent_;
  const auto rotation_rad = MeanRotation(hands, swing && !bent_);
  if (hands.left.mounted && hands.right.mounted) return hang ? MeanRoll(hands) : rotation_rad;
  const auto frequency_hz =
      MeanOf(hands, &LimbFeatures::frequency_valid, &LimbFeatures::frequency_hz);
  if (swing && rotation_rad && frequency_hz) {
    grip_.Stride(time_s, *rotation_rad, *frequency_hz);
  } else if (hang && rotation_rad && !hands.left.moving && !hands.right.moving) {
    grip_.Hang(time_s, *rotation_rad);
  } else if (!swing) {
    grip_.Rest();
  }
  if (hang) return MeanRoll(hands);
  return rotation_rad ? grip_.TwistOf(*rotation_rad) : std::nullopt;
}

void ArmInterface::NoteMissing(double time_s, const LimbPair& hands) {
  if (hands.left.present && hands.right.present) {
    if (time_s - present_s_ > kForgetS) grip_.Forget();
    present_s_ = time_s;
  } else {
    turn_.Rest();
  }
}

biped::GaitCommand ArmInterface::Advance(double time_s, const Inputs& inputs) {
  const LimbPair& hands = inputs.hands;
  const auto elevation_rad = MeanElevation(hands);
  if (elevation_rad) {
    const double border_rad = bent_ ? mapping_.straight_arm_below_rad : mapping_.bent_above_rad;
    bent_ = *elevation_rad > border_rad;
  }
  biped::GaitCommand command = gait_.Advance(time_s, hands, bent_);
  NoteMissing(time_s, hands);
  command.turn_per_step_rad = turn_.Advance(time_s, TurnRight(time_s, hands));

  state_ = {.interface = stream::UserInterface::kArm,
            .forearms = {.valid = elevation_rad.has_value(),
                         .elevation_rad = elevation_rad.value_or(0),
                         .bent_rad = mapping_.bent_above_rad},
            .turn = {.valid = turn_.valid(),
                     .source = stream::TurnSource::kHands,
                     .share = turn_.share()},
            .missing_roles = Missing(hands.left, DeviceRole::kLeftHand) |
                             Missing(hands.right, DeviceRole::kRightHand)};
  gait_.Describe(hands, state_);
  return command;
}

}  // namespace footing::mapping
