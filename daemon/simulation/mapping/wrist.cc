#include "daemon/simulation/mapping/wrist.h"

namespace footing::mapping {

Result<WristMapping> ParseWristMapping(const std::string& text, const std::string& origin) {
  WristMapping mapping;
  TableFields fields;
  AddFields(mapping.swing, fields);
  AddFields(mapping.border, fields);
  AddFields(mapping.turn, false, fields);
  if (const auto read = ReadTable(text, origin, fields); !read) return read.error();
  if (!mapping.swing.IsOrdered() || !mapping.turn.IsOrdered()) return NotOrdered(origin);
  return mapping;
}

biped::GaitCommand WristInterface::Advance(double time_s, const Inputs& inputs) {
  const LimbPair& hands = inputs.hands;
  const auto frequency_hz =
      MeanOf(hands, &LimbFeatures::frequency_valid, &LimbFeatures::frequency_hz);
  const bool run = frequency_hz && mapping_.border.IsRun(*frequency_hz, gait_.gait());
  biped::GaitCommand command = gait_.Advance(time_s, hands, run);
  if (!hands.left.present && !hands.right.present) turn_.Rest();
  command.turn_per_step_rad = turn_.Advance(
      time_s, MeanOf(hands, &LimbFeatures::inclination_valid, &LimbFeatures::roll_rad));

  state_ = {
      .interface = stream::UserInterface::kWrist,
      .border_hz = mapping_.border.border_hz,
      .turn = {
          .valid = turn_.valid(), .source = stream::TurnSource::kHands, .share = turn_.share()}};
  gait_.Describe(hands, state_);
  state_.missing_roles = Missing(hands.left, stream::DeviceRole::kLeftHand) |
                         Missing(hands.right, stream::DeviceRole::kRightHand);
  return command;
}

}  // namespace footing::mapping
