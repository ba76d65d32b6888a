#include "daemon/simulation/gait_service/applied_input.h"

#include <algorithm>

#include "common/stream/gait.h"
#include "common/wire/scalar.h"
#include "common/wire/wire.h"

namespace footing::gait_service {
namespace {

using wire::Finite;
using wire::FromProto;
using wire::ToProto;

/// One part of a person's inputs; what is not there is left out.
template <typename Part, typename Message>
void WriteIfAny(const Part& part, v1::AppliedInput& message,
                Message* (v1::AppliedInput::*mutable_part)()) {
  if (part != Part{}) wire::Write(part, *(message.*mutable_part)());
}

/// Devices that a person wears, holds and stands on.
void WriteFeatures(const mapping::Inputs& inputs, v1::AppliedInput& message) {
  using Message = v1::AppliedInput;
  wire::Write(inputs.hands.left, *message.mutable_left());
  wire::Write(inputs.hands.right, *message.mutable_right());
  message.set_phase_valid(inputs.hands.phase_valid);
  message.set_phase_rad(Finite(inputs.hands.phase_rad));
  WriteIfAny(inputs.legs.left, message, &Message::mutable_left_leg);
  WriteIfAny(inputs.legs.right, message, &Message::mutable_right_leg);
  message.set_legs_phase_valid(inputs.legs.phase_valid);
  message.set_legs_phase_rad(Finite(inputs.legs.phase_rad));
  WriteIfAny(inputs.head, message, &Message::mutable_head);
  WriteIfAny(inputs.trunk, message, &Message::mutable_trunk);
  WriteIfAny(inputs.stick, message, &Message::mutable_stick);
  WriteIfAny(inputs.left_board, message, &Message::mutable_left_board);
  WriteIfAny(inputs.right_board, message, &Message::mutable_right_board);
  message.set_simulated(inputs.simulated);
}

mapping::Inputs FeaturesFrom(const v1::AppliedInput& message) {
  mapping::Inputs inputs;
  inputs.hands = {FromProto(message.left()), FromProto(message.right()), message.phase_valid(),
                  Finite(message.phase_rad())};
  inputs.legs = {FromProto(message.left_leg()), FromProto(message.right_leg()),
                 message.legs_phase_valid(), Finite(message.legs_phase_rad())};
  inputs.head = FromProto(message.head());
  inputs.trunk = FromProto(message.trunk());
  inputs.stick = FromProto(message.stick());
  inputs.left_board = FromProto(message.left_board());
  inputs.right_board = FromProto(message.right_board());
  inputs.simulated = message.simulated();
  return inputs;
}

void WriteInterface(const engine::InterfaceInputs& interface, v1::AppliedInput& message) {
  message.set_interface_number(interface.number);
  message.set_interface(static_cast<v1::UserInterface>(interface.options.interface));
  message.set_turn_by(static_cast<v1::TurnSource>(interface.options.leg.turn_by));
  message.set_boards_may_be_left(interface.options.boards_may_be_left);
}

engine::InterfaceInputs InterfaceFrom(const v1::AppliedInput& message) {
  engine::InterfaceInputs interface;
  interface.number = message.interface_number();
  const bool named = v1::UserInterface_IsValid(message.interface()) &&
                     message.interface() != v1::USER_INTERFACE_UNSPECIFIED;
  if (!named) return interface;
  interface.options.interface = static_cast<stream::UserInterface>(message.interface());
  interface.options.leg.turn_by = v1::TurnSource_IsValid(message.turn_by())
                                      ? static_cast<stream::TurnSource>(message.turn_by())
                                      : stream::TurnSource::kUnspecified;
  interface.options.boards_may_be_left = message.boards_may_be_left();
  return interface;
}

void WriteAppends(const engine::EngineInputs& inputs, v1::AppliedInput& message) {
  message.set_append_number(inputs.append_number);
  for (int i = 0; i < inputs.append_count; ++i) {
    const terrain::NewSegment& segment = inputs.appends[static_cast<std::size_t>(i)];
    v1::AppendedSegment& one = *message.add_appends();
    one.set_length_m(Finite(segment.length_m));
    one.set_slope_rad(Finite(segment.slope_rad));
    one.set_curve_rad(Finite(segment.curve_rad));
    one.set_step_m(Finite(segment.step_m));
    one.set_pit(segment.pit);
  }
}

void TakeAppends(const v1::AppliedInput& message, engine::EngineInputs& inputs) {
  inputs.append_number = message.append_number();
  inputs.append_count = std::min(message.appends_size(), engine::kMaxAppends);
  for (int i = 0; i < inputs.append_count; ++i) {
    const v1::AppendedSegment& one = message.appends(i);
    inputs.appends[static_cast<std::size_t>(i)] = {Finite(one.length_m()), Finite(one.slope_rad()),
                                                   Finite(one.curve_rad()), Finite(one.step_m()),
                                                   one.pit()};
  }
}

}  // namespace

v1::AppliedInput ToAppliedInput(const Applied& applied) {
  v1::AppliedInput message;
  message.set_step(applied.step);
  message.set_sensor_epoch(applied.inputs.sensor_epoch);
  message.set_sensor_sequence(applied.inputs.sensor_sequence);
  const engine::EngineInputs& inputs = applied.inputs.engine;
  message.set_features_number(inputs.features_number);
  WriteFeatures(inputs.features, message);
  WriteInterface(inputs.interface, message);
  message.set_direct(inputs.direct);
  message.set_direct_gait(static_cast<v1::Gait>(inputs.direct_command.gait));
  message.set_direct_speed_mps(Finite(inputs.direct_command.speed_mps));
  message.set_direct_height_m(Finite(inputs.direct_command.height_m));
  message.set_direct_turn_rad(Finite(inputs.direct_command.turn_per_step_rad));
  message.set_push_number(inputs.push_number);
  message.set_push_x_ns(Finite(inputs.push_impulse_W_ns.x()));
  message.set_push_y_ns(Finite(inputs.push_impulse_W_ns.y()));
  message.set_put_back_number(inputs.put_back_number);
  WriteAppends(inputs, message);
  message.set_trial_number(inputs.trial.number);
  message.set_trial_task(static_cast<std::uint32_t>(inputs.trial.task + 1));
  message.set_trials_stopped_below(inputs.trial.stopped_below);
  message.set_track_number(inputs.trial.track_number);
  return message;
}

Applied FromAppliedInput(const v1::AppliedInput& message) {
  Applied applied;
  applied.step = message.step();
  applied.inputs.sensor_epoch = message.sensor_epoch();
  applied.inputs.sensor_sequence = message.sensor_sequence();
  engine::EngineInputs& inputs = applied.inputs.engine;
  inputs.features_number = message.features_number();
  inputs.features = FeaturesFrom(message);
  inputs.interface = InterfaceFrom(message);
  inputs.direct = message.direct();
  inputs.direct_command.gait = stream::GaitNumbered(message.direct_gait());
  inputs.direct_command.speed_mps = Finite(message.direct_speed_mps());
  inputs.direct_command.height_m = Finite(message.direct_height_m());
  inputs.direct_command.turn_per_step_rad = Finite(message.direct_turn_rad());
  inputs.push_number = message.push_number();
  inputs.push_impulse_W_ns = {Finite(message.push_x_ns()), Finite(message.push_y_ns())};
  inputs.put_back_number = message.put_back_number();
  TakeAppends(message, inputs);
  inputs.trial.number = message.trial_number();
  inputs.trial.task = static_cast<int>(message.trial_task()) - 1;
  inputs.trial.stopped_below = message.trials_stopped_below();
  inputs.trial.track_number = message.track_number();
  return applied;
}

}  // namespace footing::gait_service
