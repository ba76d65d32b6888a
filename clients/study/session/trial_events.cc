#include "clients/study/session/trial_events.h"

#include <cmath>
#include <utility>

#include "common/stream/response.h"
#include "common/base/number.h"
#include "common/wire/wire.h"

namespace footing::study {
namespace {

using nlohmann::ordered_json;
using records::EventKind;

/// Of the task with that name; kUnspecified: the track has none.
stream::Gait WantedGait(const stream::Track& track, const std::string& task) {
  for (const stream::TrackTask& one : track.tasks) {
    if (one.name == task) return one.after;
  }
  return stream::Gait::kUnspecified;
}

}  // namespace

TrialEvents::TrialEvents(SessionContext& context, Servers& servers, std::string id)
    : context_(context), servers_(servers), id_(std::move(id)), tracker_(id_) {}

TrialEvents::~TrialEvents() {
  servers_.set_on_frame(nullptr);
  servers_.set_on_event(nullptr);
}

void TrialEvents::Begin() {
  servers_.set_on_event([this](const v1::Event& event) { OnEvent(event); });
  servers_.set_on_frame([this](const SimulationFrame& frame) { OnFrame(frame); });
}

void TrialEvents::OnFrame(const SimulationFrame& frame) {
  if (ended_) return;
  const stream::TrialState& trial = frame.trial;
  const std::string shown = tracker_.state().instruction;
  if (!tracker_.Add(trial)) return;
  if (trial.progress.phase == stream::TrialPhase::kRunning && trial.progress.on_track) {
    heading_.Add(trial.progress.heading_error_rad);
  }
  const stream::TaskPhase task = trial.progress.task_phase;
  if (task == stream::TaskPhase::kAhead || task == stream::TaskPhase::kDue) {
    anticipation_.Add({.host_ns = frame.host_ns,
                       .to_mark_m = trial.to_mark_m,
                       .commanded = frame.commanded_gait,
                       .running = frame.gait,
                       .wanted = WantedGait(servers_.track(), trial.task)});
  }
  if (!trial.instruction.empty() && trial.instruction != shown) {
    context_.console.Print("Task for the participant: " + trial.instruction);
  }
}

void TrialEvents::OnEvent(const v1::Event& event) {
  if (event.kind() == v1::Event::KIND_CORRECTION && event.failure().trial() == id_) {
    OnCorrection(event.failure());
  }
  if (ended_) return;
  // Responses do not name a trial; while nothing has begun they belong to none.
  if (event.kind() == v1::Event::KIND_RESPONSE && tracker_.begun()) OnResponse(event.response());
  if (event.kind() == v1::Event::KIND_FALL) heading_.SetUpright(false);
  if (event.kind() == v1::Event::KIND_PUT_BACK) heading_.SetUpright(true);
  if (event.kind() == v1::Event::KIND_FALL && event.failure().trial() == id_) OnFailure(event);
}

/// By this program or by another console.
void TrialEvents::OnCorrection(const v1::Failure& failure) {
  Append(failure.withdrawn() ? EventKind::kFailureUndone : EventKind::kFailureRestored,
         {{"trial", id_}, {"failure", failure.number()}});
  context_.console.Print("failure " + std::to_string(failure.number()) +
                         (failure.withdrawn() ? " undone" : " restored"));
}

void TrialEvents::OnFailure(const v1::Event& event) {
  const v1::Failure& failure = event.failure();
  const char* kind = stream::Name(static_cast<stream::FailureCause>(failure.cause()));
  Append(EventKind::kFailure, {{"trial", id_},
                               {"failure", failure.number()},
                               {"kind", kind},
                               {"trial_time_s", failure.trial_time_s()},
                               {"distance_m", failure.distance_m()},
                               {"lateral_offset_m", failure.lateral_offset_m()},
                               {"heading_error_rad", failure.heading_error_rad()},
                               {"host_ns", event.host_ns()}});
  context_.console.Print("failure " + std::to_string(failure.number()) + ": " + kind + ", " +
                         text::Fixed(failure.trial_time_s(), 1) + " s");
}

void TrialEvents::OnResponse(const v1::ResponseStages& response) {
  const stream::ResponseStages stamps = wire::FromProto(response);
  ordered_json stages = ordered_json::object();
  for (const stream::ResponseStage& stage : stream::ResponseTimes(stamps)) {
    stages[stage.name] = stage.ms;
  }
  if (stages.empty()) return;
  Append(EventKind::kResponse, {{"trial", id_},
                                {"from", stream::Name(stamps.from)},
                                {"to", stream::Name(stamps.to)},
                                {"stages_ms", std::move(stages)}});
}

void TrialEvents::Append(EventKind kind, ordered_json fields) {
  auto written = context_.journal.Append(kind, std::move(fields));
  if (!written && written_) written_ = std::move(written);
}

ordered_json TrialEvents::Figures() const {
  const stream::TrialProgress& progress = tracker_.state().progress;
  ordered_json fields = {{"time_s", progress.time_s},
                         {"distance_m", progress.distance_m},
                         {"failed_attempts", stream::Total(progress.failures)},
                         {"operator_put_backs", progress.operator_put_backs}};
  const double oscillation_rad = heading_.StandardDeviation();
  if (std::isfinite(oscillation_rad)) fields["heading_oscillation_rad"] = oscillation_rad;
  if (tracker_.state().task.empty()) return fields;
  fields["task_done"] = progress.task_phase == stream::TaskPhase::kDone;
  // Of a task that was never done there is nothing to say.
  const auto anticipation_s = anticipation_.seconds();
  if (fields["task_done"] && anticipation_s) fields["anticipation_s"] = *anticipation_s;
  return fields;
}

}  // namespace footing::study
