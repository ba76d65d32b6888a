#include "daemon/simulation/gait_service/publish.h"

#include "common/wire/wire.h"
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
      return "gait commanded: " + gaits;
    case engine::EventKind::kGaitTakenOver:
      return "gait begins: " + gaits;
    case engine::EventKind::kGaitChanged:
      return "gait changed: " + gaits;
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
  for (const auto& pose : output.links) *character.add_links() = wire::ToProto(pose);
  for (const auto& contact : output.contacts) *character.add_contacts() = wire::ToProto(contact);
  *character.mutable_gait() = wire::ToProto(output.gait);
  *character.mutable_interface() = wire::ToProto(output.interface);
  return message;
}

v1::Event ToEvent(const engine::EngineEvent& event, std::int64_t host_ns) {
  v1::Event message = serving::MakeEvent(ToKind(event.kind), host_ns, ToText(event));
  message.set_gait(static_cast<v1::Gait>(event.to));
  message.set_failure_cause(static_cast<v1::FailureCause>(event.cause));
  message.set_by_operator(event.by_operator);
  message.set_segment_refused(event.kind == engine::EventKind::kAppendRefused);
  return message;
}

}  // namespace footing::gait_service
