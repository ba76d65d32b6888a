#include "clients/study/session/trial_run.h"

#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "clients/study/gate/device_gate.h"
#include "clients/study/journal/study_folder.h"
#include "clients/study/records/trials.h"
#include "clients/study/session/heading.h"
#include "clients/study/session/trial_recorder.h"
#include "common/clock/clock.h"
#include "common/text/number.h"
#include "common/units/units.h"

namespace footing::study {
namespace {

using nlohmann::ordered_json;
using records::EventKind;

constexpr double kConfirmedWithinS = 2;
// Longer than a pause of the radio, shorter than it takes the participant to wonder.
constexpr double kDeviceBackS = 2;

v1::Command StartCommand(const std::string& id, const plan::Phase& phase) {
  v1::Command command;
  v1::StartTrial& start = *command.mutable_start_trial();
  start.set_character(1);
  start.set_trial(id);
  start.set_track(phase.track);
  start.set_seed(phase.seed);
  start.set_task(phase.task);
  return command;
}

mcap::TextMap ToTextMap(const ordered_json& fields) {
  mcap::TextMap texts;
  for (const auto& [key, value] : fields.items()) {
    texts[key] = value.is_string() ? value.get<std::string>() : value.dump();
  }
  return texts;
}

Result<void> Withdraw(Servers& servers, std::uint64_t failure) {
  v1::Command command;
  command.mutable_correct_failure()->set_failure(failure);
  command.mutable_correct_failure()->set_reason("undone by the experimenter");
  return servers.Call(std::move(command));
}

class TrialRun {
 public:
  TrialRun(SessionContext& context, Servers& servers, const plan::Phase& phase, std::size_t attempt)
      : context_(context), servers_(servers), phase_(phase), attempt_(attempt) {
    id_ = context.session.participant + "." + phase.id + "." + std::to_string(attempt);
    file_ = phase.id + "." + std::to_string(attempt) + ".mcap";
  }
  ~TrialRun() {
    servers_.set_on_trial(nullptr);
    servers_.set_on_event(nullptr);
    context_.console.ReadKeys(false);
  }
  TrialRun(const TrialRun&) = delete;
  TrialRun& operator=(const TrialRun&) = delete;

  Result<std::string> Run() {
    if (const auto done = Begin(); !done) return done.error();
    const auto outcome = Wait();
    if (!outcome) return outcome.error();
    if (*outcome != "finished") {
      if (const auto done = Stop(); !done) return done.error();
    }
    if (const auto done = Finish(*outcome); !done) return done.error();
    return outcome;
  }

 private:
  ordered_json Marks() const {
    return {{"trial", id_},
            {"phase", phase_.id},
            {"interface", phase_.interface},
            {"kind", Name(phase_.kind)},
            {"track", phase_.track},
            {"task", phase_.task},
            {"seed", phase_.seed},
            {"attempt", attempt_},
            {"recording", file_}};
  }

  mcap::TextMap MarksOfRecording() const {
    mcap::TextMap marks = ToTextMap(Marks());
    marks["participant"] = context_.session.participant;
    marks["synthetic"] = context_.options.unattended ? "true" : "false";
    std::string order;
    for (const std::string& one : context_.session.interfaces) {
      order += (order.empty() ? "" : " ") + one;
    }
    marks["order"] = order;
    marks["study_seed"] = std::to_string(context_.protocol.seed);
    return marks;
  }

  Result<void> Begin() {
    TrialRecorder::Options recording;
    recording.path =
        journal::ParticipantFolder(context_.options.study_folder, context_.session.participant) +
        "/" + file_;
    recording.version = context_.options.version;
    recording.addresses = {context_.options.sensor,
                           SimulationOf(context_.options, phase_.interface)};
    recording.attachments = {{"protocol.json", context_.options.protocol_text}};
    auto recorder =
        TrialRecorder::Begin(context_.console, std::move(recording), MarksOfRecording());
    if (!recorder) return recorder.error();
    recorder_ = std::move(*recorder);
    if (const auto done = context_.journal.Append(EventKind::kTrialStarted, Marks()); !done) {
      return done;
    }
    servers_.set_on_event([this](const v1::Event& event) { OnEvent(event); });
    servers_.set_on_trial([this](const stream::TrialState& trial) { OnTrial(trial); });
    begin_ns_ = complete_ns_ = clock::MonotonicNs();
    if (const auto done = servers_.Call(StartCommand(id_, phase_)); !done) return done;
    if (!context_.options.unattended) {
      context_.console.Print(id_ + " on track " + phase_.track +
                             (phase_.task.empty() ? "" : ", task " + phase_.task) +
                             ". Keys: s stops the trial, u undoes the newest failure.");
      context_.console.ReadKeys(true);
    }
    return {};
  }

  void OnTrial(const stream::TrialState& trial) {
    if (trial.trial != id_) return;
    if (trial.progress.phase == stream::TrialPhase::kRunning && trial.progress.on_track) {
      heading_.Add(trial.progress.heading_error_rad);
    }
    if (!trial.instruction.empty() && trial.instruction != state_.instruction) {
      context_.console.Print("Task for the participant: " + trial.instruction);
    }
    state_ = trial;
  }

  void OnEvent(const v1::Event& event) {
    const v1::Failure& failure = event.failure();
    if (failure.trial() != id_) return;
    if (event.kind() == v1::Event::KIND_CORRECTION) OnCorrection(failure);
    if (event.kind() == v1::Event::KIND_FALL) OnFailure(event);
  }

  /// By this program or by another console.
  void OnCorrection(const v1::Failure& failure) {
    Keep(context_.journal.Append(
        failure.withdrawn() ? EventKind::kFailureUndone : EventKind::kFailureRestored,
        {{"failure", failure.number()}}));
    if (failure.number() == newest_failure_) newest_failure_ = 0;
    context_.console.Print("failure " + std::to_string(failure.number()) +
                           (failure.withdrawn() ? " undone" : " restored"));
  }

  void OnFailure(const v1::Event& event) {
    const v1::Failure& failure = event.failure();
    newest_failure_ = failure.number();
    const char* kind = stream::Name(static_cast<stream::FailureCause>(failure.cause()));
    Keep(context_.journal.Append(EventKind::kFailure,
                                 {{"trial", id_},
                                  {"failure", failure.number()},
                                  {"kind", kind},
                                  {"trial_time_s", failure.trial_time_s()},
                                  {"distance_m", failure.distance_m()},
                                  {"lateral_offset_m", failure.lateral_offset_m()},
                                  {"heading_error_rad", failure.heading_error_rad()},
                                  {"host_ns", event.host_ns()}}));
    context_.console.Print("failure " + std::to_string(failure.number()) + ": " + kind + ", " +
                           text::Fixed(failure.trial_time_s(), 1) + " s");
  }

  void Keep(Result<void> written) {
    if (!written && written_) written_ = std::move(written);
  }

  /// Until the finish line, the time limit, or a key.
  Result<std::string> Wait() {
    const std::int64_t end_ns = begin_ns_ + SecondsToNanoseconds(context_.protocol.trial_limit_s);
    for (;;) {
      std::optional<char> key;
      const Waited waited = context_.console.RunUntil(
          [&] {
            if (!context_.options.unattended) key = context_.console.TakeKey();
            return key || Over() || !written_ || !recorder_->written() || !servers_.live() ||
                   DeviceLost();
          },
          std::max(0.0, NanosecondsToSeconds(end_ns - clock::MonotonicNs())));
      if (waited == Waited::kInterrupted) return Interrupted();
      if (!written_) return written_.error();
      if (!recorder_->written()) return recorder_->written().error();
      if (Over()) return std::string("finished");
      if (waited == Waited::kTimeUp) return std::string("timed_out");
      if (!servers_.live()) return Failure("the trial broke off: " + servers_.Links());
      if (DeviceLost()) return std::string(records::kDeviceLost);
      if (key == 's') return std::string("stopped");
      if (key == 'u' && newest_failure_ != 0) {
        if (const auto done = UndoNewest(); !done) return done.error();
      }
    }
  }

  /// Returns when the correction is in the journal.
  Result<void> UndoNewest() {
    if (const auto done = Withdraw(servers_, newest_failure_); !done) return done;
    const Waited waited =
        context_.console.RunUntil([&] { return newest_failure_ == 0; }, kConfirmedWithinS);
    if (waited == Waited::kInterrupted) return Interrupted();
    if (waited == Waited::kTimeUp) return Failure("footing-sim has not confirmed the correction");
    return {};
  }

  /// A device that the interface needs has sent nothing for a while.
  bool DeviceLost() {
    lost_role_ = gate::Lost(phase_.interface, servers_.devices());
    const std::int64_t now_ns = clock::MonotonicNs();
    if (lost_role_.empty()) complete_ns_ = now_ns;
    return NanosecondsToSeconds(now_ns - complete_ns_) > kDeviceBackS;
  }

  bool Over() const { return state_.progress.phase == stream::TrialPhase::kFinished; }

  Result<void> Stop() {
    v1::Command command;
    command.mutable_stop_trial()->set_character(1);
    command.mutable_stop_trial()->set_trial(id_);
    if (const auto done = servers_.Call(std::move(command)); !done) return done;
    const Waited waited = context_.console.RunUntil(
        [&] { return state_.progress.phase == stream::TrialPhase::kStopped || Over(); },
        kConfirmedWithinS);
    if (waited == Waited::kInterrupted) return Interrupted();
    return {};
  }

  Result<void> Finish(const std::string& outcome) {
    ordered_json fields = {{"trial", id_},
                           {"outcome", outcome},
                           {"time_s", state_.progress.time_s},
                           {"wall_s", NanosecondsToSeconds(clock::MonotonicNs() - begin_ns_)},
                           {"distance_m", state_.progress.distance_m},
                           {"failed_attempts", stream::Total(state_.progress.failures)},
                           {"operator_put_backs", state_.progress.operator_put_backs}};
    const double oscillation_rad = heading_.StandardDeviation();
    if (std::isfinite(oscillation_rad)) fields["heading_oscillation_rad"] = oscillation_rad;
    if (!phase_.task.empty()) {
      fields["task_done"] = state_.progress.task_phase == stream::TaskPhase::kDone;
    }
    if (outcome == records::kDeviceLost) fields["device"] = lost_role_;
    if (const auto done = recorder_->Finish(ToTextMap(fields)); !done) return done;
    return context_.journal.Append(EventKind::kTrialFinished, std::move(fields));
  }

  SessionContext& context_;
  Servers& servers_;
  const plan::Phase& phase_;
  std::size_t attempt_;
  std::string id_, file_;
  std::unique_ptr<TrialRecorder> recorder_;
  stream::TrialState state_;
  HeadingOscillation heading_;
  std::uint64_t newest_failure_ = 0;
  std::int64_t begin_ns_ = 0;
  std::int64_t complete_ns_ = 0;  ///< When all devices were last there.
  std::string lost_role_;
  Result<void> written_;
};

}  // namespace

Result<std::string> RunTrial(SessionContext& context, Servers& servers, const plan::Phase& phase,
                             std::size_t attempt) {
  return TrialRun(context, servers, phase, attempt).Run();
}

Result<void> PlaceOnTrack(Servers& servers, const std::string& id, const plan::Phase& phase) {
  return servers.Call(StartCommand(id, phase));
}

Result<void> UndoFailure(SessionContext& context, Servers& servers, std::uint64_t failure) {
  if (const auto done = Withdraw(servers, failure); !done) return done;
  context.console.Print("failure " + std::to_string(failure) + " undone");
  return context.journal.Append(EventKind::kFailureUndone, {{"failure", failure}});
}

}  // namespace footing::study
