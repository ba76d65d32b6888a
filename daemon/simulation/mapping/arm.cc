#include "daemon/simulation/mapping/arm.h"

#include <algorithm>
#include <cmath>

#include "common/units/units.h"

namespace footing::mapping {
namespace {

using stream::DeviceRole;

std::optional<double> MeanElevation(const LimbPair& hands) {
  const auto left_rad = ForearmElevation(hands.left), right_rad = ForearmElevation(hands.right);
  if (!left_rad || !right_rad) return std::nullopt;
  return (*left_rad + *right_rad) / 2;
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

std::optional<double> ArmInterface::TurnRight(const LimbPair& hands) const {
  const LimbFeatures &left = hands.left, &right = hands.right;
  if (!bent_ && left.moving && right.moving) {
    if (!left.swing_valid || !right.swing_valid) return std::nullopt;
    return (left.swing_rad + right.swing_rad) / 2;
  }
  if (!left.inclination_valid || !right.inclination_valid) return std::nullopt;
  return (left.roll_rad + right.roll_rad) / 2;
}

biped::GaitCommand ArmInterface::Advance(double time_s, const Inputs& inputs) {
  const LimbPair& hands = inputs.hands;
  const auto elevation_rad = MeanElevation(hands);
  if (elevation_rad) {
    const double border_rad = bent_ ? mapping_.straight_arm_below_rad : mapping_.bent_above_rad;
    bent_ = *elevation_rad > border_rad;
  }
  biped::GaitCommand command = gait_.Advance(time_s, hands, bent_);
  if (!hands.left.present || !hands.right.present) turn_.Rest();
  command.turn_per_step_rad = turn_.Advance(time_s, TurnRight(hands));

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
