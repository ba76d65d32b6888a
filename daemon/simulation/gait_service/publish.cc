#include "daemon/simulation/gait_service/publish.h"

#include <algorithm>

#include "common/wire/wire.h"

namespace footing::gait_service {
namespace {

v1::Event::Kind ToKind(engine::EventKind kind) {
  switch (kind) {
    case engine::EventKind::kFall:
      return v1::Event::KIND_FALL;
    case engine::EventKind::kPutBack:
      return v1::Event::KIND_PUT_BACK;
    case engine::EventKind::kGaitCommanded:
    case engine::EventKind::kGaitTakenOver:
    case engine::EventKind::kAppendRefused:
      return v1::Event::KIND_COMMAND;
    case engine::EventKind::kGaitChanged:
      return v1::Event::KIND_GAIT_CHANGED;
    case engine::EventKind::kStreamLost:
      return v1::Event::KIND_STREAM_LOST;
    case engine::EventKind::kStreamBack:
      return v1::Event::KIND_STREAM_BACK;
    case engine::EventKind::kTrialReady:
    case engine::EventKind::kTrialRunning:
    case engine::EventKind::kTrialFinished:
    case engine::EventKind::kTrialStopped:
      return v1::Event::KIND_TRIAL;
    case engine::EventKind::kTaskDone:
      return v1::Event::KIND_TASK;
  }
  return v1::Event::KIND_UNSPECIFIED;
}

std::string ToText(const engine::EngineEvent& event) {
  const std::string gaits = std::string(stream::Name(event.from)) + " to " + stream::Name(event.to);
  switch (event.kind) {
    case engine::EventKind::kGaitCommanded:
      return "commanded: " + gaits;
    case engine::EventKind::kGaitTakenOver:
      return "taken over: " + gaits;
    case engine::EventKind::kGaitChanged:
      return "changed: " + gaits;
    case engine::EventKind::kFall:
      return std::string("failure (") + stream::Name(event.cause) + "): " + event.text;
    case engine::EventKind::kPutBack:
      return std::string("put back ") + event.text;
    case engine::EventKind::kStreamLost:
    case engine::EventKind::kStreamBack:
    case engine::EventKind::kAppendRefused:
      return event.text;
    case engine::EventKind::kTrialReady:
    case engine::EventKind::kTrialRunning:
    case engine::EventKind::kTrialFinished:
    case engine::EventKind::kTrialStopped:
      return std::string("trial ") + stream::Name(event.trial.phase);
    case engine::EventKind::kTaskDone:
      return "task done";
  }
  return event.text;
}

void SetHand(const mapping::HandFeatures& hand, v1::HandInput& message) {
  message.set_present(hand.present);
  message.set_moving(hand.moving);
  message.set_frequency_valid(hand.frequency_valid);
  message.set_frequency_hz(hand.frequency_hz);
  message.set_amplitude_valid(hand.amplitude_valid);
  message.set_amplitude_mps2(hand.amplitude_mps2);
  message.set_inclination_valid(hand.inclination_valid);
  message.set_roll_rad(hand.roll_rad);
}

mapping::HandFeatures GetHand(const v1::HandInput& message) {
  mapping::HandFeatures hand;
  hand.present = message.present();
  hand.moving = message.moving();
  hand.frequency_valid = message.frequency_valid();
  hand.frequency_hz = message.frequency_hz();
  hand.amplitude_valid = message.amplitude_valid();
  hand.amplitude_mps2 = message.amplitude_mps2();
  hand.inclination_valid = message.inclination_valid();
  hand.roll_rad = message.roll_rad();
  return hand;
}

}  // namespace

v1::CharacterFrame ToCharacterFrame(const Frame& frame, const std::string& world,
                                    const std::string& rig) {
  const engine::EngineOutput& output = frame.output;
  v1::CharacterFrame message;
  message.set_world(world);
  message.set_step(output.step);
  message.set_time_s(output.time_s);
  message.set_overruns(frame.overruns);
  message.set_state_hash(output.state_hash);
  v1::Character& character = *message.add_characters();
  character.set_character(1);
  character.set_rig(rig);
  character.set_valid(true);
  for (const auto& pose : output.links) *character.add_links() = wire::ToProto(pose);
  for (const auto& contact : output.contacts) *character.add_contacts() = wire::ToProto(contact);
  *character.mutable_com_m() = wire::ToProto(output.p_WC_m);
  *character.mutable_com_velocity_mps() = wire::ToProto(output.v_WC_mps);
  *character.mutable_gait() = wire::ToProto(output.gait);
  character.set_simulated_input(output.simulated_input);
  return message;
}

v1::Event ToEvent(const engine::EngineEvent& event, std::int64_t host_ns) {
  v1::Event message;
  message.set_kind(ToKind(event.kind));
  message.set_host_ns(host_ns);
  message.set_character(1);
  message.set_text(ToText(event));
  message.set_gait(static_cast<v1::Gait>(event.to));
  message.set_failure_cause(static_cast<v1::FailureCause>(event.cause));
  message.set_by_operator(event.by_operator);
  return message;
}

v1::AppliedInput ToAppliedInput(const Applied& applied) {
  const engine::EngineInputs& inputs = applied.inputs.engine;
  v1::AppliedInput message;
  message.set_step(applied.step);
  message.set_sensor_epoch(applied.inputs.sensor_epoch);
  message.set_sensor_sequence(applied.inputs.sensor_sequence);
  message.set_features_number(inputs.features_number);
  SetHand(inputs.features.left, *message.mutable_left());
  SetHand(inputs.features.right, *message.mutable_right());
  message.set_phase_valid(inputs.features.phase_valid);
  message.set_phase_rad(inputs.features.phase_rad);
  message.set_simulated(inputs.features.simulated);
  message.set_direct(inputs.direct);
  message.set_direct_gait(static_cast<v1::Gait>(inputs.direct_command.gait));
  message.set_direct_speed_mps(inputs.direct_command.speed_mps);
  message.set_direct_height_m(inputs.direct_command.height_m);
  message.set_direct_turn_rad(inputs.direct_command.turn_per_step_rad);
  message.set_push_number(inputs.push_number);
  message.set_push_x_ns(inputs.push_impulse_W_ns.x());
  message.set_push_y_ns(inputs.push_impulse_W_ns.y());
  message.set_put_back_number(inputs.put_back_number);
  message.set_append_number(inputs.append_number);
  for (int i = 0; i < inputs.append_count; ++i) {
    const terrain::NewSegment& segment = inputs.appends[static_cast<std::size_t>(i)];
    v1::AppendedSegment& append = *message.add_appends();
    append.set_length_m(segment.length_m);
    append.set_slope_rad(segment.slope_rad);
    append.set_curve_rad(segment.curve_rad);
    append.set_step_m(segment.step_m);
    append.set_pit(segment.pit);
  }
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
  inputs.features.left = GetHand(message.left());
  inputs.features.right = GetHand(message.right());
  inputs.features.phase_valid = message.phase_valid();
  inputs.features.phase_rad = message.phase_rad();
  inputs.features.simulated = message.simulated();
  inputs.direct = message.direct();
  inputs.direct_command.gait = stream::GaitNumbered(message.direct_gait());
  inputs.direct_command.speed_mps = message.direct_speed_mps();
  inputs.direct_command.height_m = message.direct_height_m();
  inputs.direct_command.turn_per_step_rad = message.direct_turn_rad();
  inputs.push_number = message.push_number();
  inputs.push_impulse_W_ns = {message.push_x_ns(), message.push_y_ns()};
  inputs.put_back_number = message.put_back_number();
  inputs.append_number = message.append_number();
  inputs.append_count = std::min(message.appends_size(), engine::kMaxAppends);
  for (int i = 0; i < inputs.append_count; ++i) {
    const v1::AppendedSegment& append = message.appends(i);
    inputs.appends[static_cast<std::size_t>(i)] = {
        append.length_m(), append.slope_rad(), append.curve_rad(), append.step_m(), append.pit()};
  }
  inputs.trial = {message.trial_number(), static_cast<int>(message.trial_task()) - 1,
                  message.trials_stopped_below(), message.track_number()};
  return applied;
}

}  // namespace footing::gait_service
