#include "daemon/simulation/gait_service/publish.h"

#include <algorithm>

#include "common/wire/fields.h"
#include "daemon/simulation/serving/messages.h"

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

using wire::FromProto;
using wire::ToProto;

template <typename Way>
void Fields(Way way, const mapping::HandFeatures&) {
  FOOTING_FIELD(present);
  FOOTING_FIELD(moving);
  FOOTING_FIELD(frequency_valid);
  FOOTING_FIELD(frequency_hz);
  FOOTING_FIELD(amplitude_valid);
  FOOTING_FIELD(amplitude_mps2);
  FOOTING_FIELD(inclination_valid);
  FOOTING_FIELD(roll_rad);
}
FOOTING_BOTH_WAYS_OF(mapping::HandFeatures, v1::HandInput)

template <typename Way>
void Fields(Way way, const terrain::NewSegment&) {
  FOOTING_FIELD(length_m);
  FOOTING_FIELD(slope_rad);
  FOOTING_FIELD(curve_rad);
  FOOTING_FIELD(step_m);
  FOOTING_FIELD(pit);
}
FOOTING_BOTH_WAYS_OF(terrain::NewSegment, v1::AppendedSegment)

template <typename Way>
void Fields(Way way, const engine::EngineInputs&) {
  FOOTING_FIELD(features_number);
  FOOTING_MESSAGE_OF(features.left, left);
  FOOTING_MESSAGE_OF(features.right, right);
  FOOTING_FIELD_OF(features.phase_valid, phase_valid);
  FOOTING_FIELD_OF(features.phase_rad, phase_rad);
  FOOTING_FIELD_OF(features.simulated, simulated);
  FOOTING_FIELD(direct);
  FOOTING_ENUM_OF(Gait, direct_command.gait, direct_gait);
  FOOTING_FIELD_OF(direct_command.speed_mps, direct_speed_mps);
  FOOTING_FIELD_OF(direct_command.height_m, direct_height_m);
  FOOTING_FIELD_OF(direct_command.turn_per_step_rad, direct_turn_rad);
  FOOTING_FIELD(push_number);
  FOOTING_FIELD_OF(push_impulse_W_ns.x(), push_x_ns);
  FOOTING_FIELD_OF(push_impulse_W_ns.y(), push_y_ns);
  FOOTING_FIELD(put_back_number);
  FOOTING_FIELD(append_number);
  if constexpr (Way::kOut) {
    for (int i = 0; i < way.value.append_count; ++i) {
      *way.message.add_appends() = ToProto(way.value.appends[static_cast<std::size_t>(i)]);
    }
  } else {
    way.value.append_count = std::min(way.message.appends_size(), engine::kMaxAppends);
    for (int i = 0; i < way.value.append_count; ++i) {
      way.value.appends[static_cast<std::size_t>(i)] = FromProto(way.message.appends(i));
    }
  }
  FOOTING_FIELD_OF(trial.number, trial_number);
  if constexpr (Way::kOut) {
    way.message.set_trial_task(static_cast<std::uint32_t>(way.value.trial.task + 1));
  } else {
    way.value.trial.task = static_cast<int>(way.message.trial_task()) - 1;
  }
  FOOTING_FIELD_OF(trial.stopped_below, trials_stopped_below);
  FOOTING_FIELD_OF(trial.track_number, track_number);
}

template <typename Way>
void Fields(Way way, const Applied&) {
  FOOTING_FIELD(step);
  FOOTING_FIELD_OF(inputs.sensor_epoch, sensor_epoch);
  FOOTING_FIELD_OF(inputs.sensor_sequence, sensor_sequence);
  FOOTING_PART(inputs.engine);
}
FOOTING_BOTH_WAYS_OF(Applied, v1::AppliedInput)

}  // namespace

v1::CharacterFrame ToCharacterFrame(const Frame& frame, const std::string& world,
                                    const std::string& rig) {
  const engine::EngineOutput& output = frame.output;
  v1::CharacterFrame message = serving::MakeFrame({.step = output.step,
                                                   .time_s = output.time_s,
                                                   .overruns = frame.overruns,
                                                   .state_hash = output.state_hash,
                                                   .valid = true,
                                                   .p_WC_m = output.p_WC_m,
                                                   .v_WC_mps = output.v_WC_mps,
                                                   .simulated_input = output.simulated_input},
                                                  world, rig);
  v1::Character& character = *message.mutable_characters(0);
  for (const auto& pose : output.links) *character.add_links() = ToProto(pose);
  for (const auto& contact : output.contacts) *character.add_contacts() = ToProto(contact);
  *character.mutable_gait() = ToProto(output.gait);
  return message;
}

v1::Event ToEvent(const engine::EngineEvent& event, std::int64_t host_ns) {
  v1::Event message = serving::MakeEvent(ToKind(event.kind), host_ns, ToText(event));
  message.set_gait(static_cast<v1::Gait>(event.to));
  message.set_failure_cause(static_cast<v1::FailureCause>(event.cause));
  message.set_by_operator(event.by_operator);
  return message;
}

v1::AppliedInput ToAppliedInput(const Applied& applied) { return ToProto(applied); }

Applied FromAppliedInput(const v1::AppliedInput& message) { return FromProto(message); }

}  // namespace footing::gait_service
