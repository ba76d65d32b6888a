#include "daemon/simulation/gait_service/publish.h"

#include <utility>

#include "common/wire/scalar.h"
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

bool Responses::Complete(const Frame& frame, std::int64_t now_ns, v1::ResponseStages& stages) {
  const engine::EngineOutput& output = frame.output;
  if (output.response.taken_over == 0 || output.response.taken_over == shown_step_) return false;
  shown_step_ = output.response.taken_over;
  const stream::Gait from = from_;
  from_ = output.gait.gait;
  const FeatureStamps& stamps = Slot(output.response.features_number);
  const bool from_features =
      output.response.features_number > 0 && stamps.number == output.response.features_number;
  if (!from_features || output.response.taken_over < output.response.commanded) return false;
  stages.set_from(static_cast<v1::Gait>(from));
  stages.set_to(static_cast<v1::Gait>(output.gait.gait));
  stages.set_report_received_ns(stamps.report_received_ns);
  stages.set_decoded_ns(stamps.decoded_ns);
  stages.set_features_computed_ns(stamps.computed_ns);
  stages.set_features_received_ns(stamps.received_ns);
  stages.set_command_ns(frame.command_ns);
  stages.set_contact_ns(frame.contact_ns);
  stages.set_first_frame_ns(now_ns);
  return true;
}

namespace {

constexpr std::size_t kMaxReason = 200;

}  // namespace

v1::Failure FailureRecord::Add(const engine::EngineEvent& event, const std::string& trial) {
  v1::Failure failure;
  failure.set_number(event.failure_number);
  failure.set_cause(static_cast<v1::FailureCause>(event.cause));
  if (event.in_trial) failure.set_trial(trial);
  failure.set_trial_time_s(event.trial.time_s);
  failure.set_distance_m(event.trial.distance_m);
  failure.set_lateral_offset_m(event.trial.lateral_offset_m);
  failure.set_heading_error_rad(event.trial.heading_error_rad);
  *failure.mutable_position_m() = wire::ToProto(event.p_WC_m);
  entries_[event.failure_number] = {failure, event.trial_number, event.in_trial};
  return failure;
}

Result<void> FailureRecord::Correct(const v1::CorrectFailure& message) {
  const auto found = entries_.find(message.failure());
  if (found == entries_.end()) {
    return UsageError(
        "correct_failure: failure " + std::to_string(message.failure()) + " is unknown" +
        (entries_.empty() ? std::string("; none has happened")
                          : "; the last one is " + std::to_string(entries_.rbegin()->first)));
  }
  v1::Failure& failure = found->second.failure;
  if (failure.withdrawn() != message.restore()) {
    return UsageError("correct_failure: failure " + std::to_string(message.failure()) +
                      (message.restore() ? " counts already" : " is withdrawn already"));
  }
  failure.set_withdrawn(!message.restore());
  CountWithdrawn(found->second);
  std::string text = "failure " + std::to_string(failure.number()) + " (" +
                     stream::Name(static_cast<stream::FailureCause>(failure.cause())) + ") " +
                     (message.restore() ? "restored" : "withdrawn");
  if (!message.reason().empty()) {
    text += ": " + wire::Utf8(message.reason().substr(0, kMaxReason));
  }
  v1::Event event = serving::MakeEvent(v1::Event::KIND_CORRECTION, 0, text);
  event.set_failure_cause(failure.cause());
  *event.mutable_failure() = failure;
  corrections_.push_back(std::move(event));
  return {};
}

std::vector<v1::Event> FailureRecord::TakeCorrections() {
  std::vector<v1::Event> taken;
  taken.swap(corrections_);
  return taken;
}

stream::FailureCounts FailureRecord::WithdrawnOf(std::uint64_t trial_number) const {
  const auto found = withdrawn_of_.find(trial_number);
  return found == withdrawn_of_.end() ? stream::FailureCounts{} : found->second;
}

void FailureRecord::CountWithdrawn(const Entry& entry) {
  const auto cause = static_cast<stream::FailureCause>(entry.failure.cause());
  const auto count = [&](stream::FailureCounts& counts) {
    std::uint64_t* of_cause = stream::MutableCountOf(cause, counts);
    if (of_cause == nullptr) return;
    entry.failure.withdrawn() ? ++*of_cause : --*of_cause;
  };
  count(withdrawn_);
  if (entry.in_trial) count(withdrawn_of_[entry.trial_number]);
}

}  // namespace footing::gait_service
