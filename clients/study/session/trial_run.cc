#include "clients/study/session/trial_run.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include "clients/study/plan/device_gate.h"
#include "clients/study/session/study_folder.h"
#include "clients/study/report/trials.h"
#include "clients/study/session/trial_events.h"
#include "clients/study/session/trial_recorder.h"
#include "clients/study/session/undo.h"
#include "common/runtime/clock.h"
#include "common/base/units.h"

namespace footing::study {
namespace {

using nlohmann::ordered_json;
using records::EventKind;

constexpr double kConfirmedWithinS = 2;
constexpr double kLinksWithinS = 10;  // Beyond the time after which a link counts as broken.
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

class TrialRun {
 public:
  TrialRun(SessionContext& context, Servers& servers, const ActiveTime& active, TrialEvents& events,
           const plan::Phase& phase, std::size_t attempt, std::function<void()> on_placed)
      : context_(context),
        servers_(servers),
        active_(active),
        active_before_s_(active.seconds()),
        breaks_before_(servers.breaks()),
        phase_(phase),
        attempt_(attempt),
        id_(events.trial()),
        file_(phase.id + "." + std::to_string(attempt) + ".mcap"),
        events_(events),
        on_placed_(std::move(on_placed)) {}
  ~TrialRun() { context_.console.ReadKeys(false); }
  TrialRun(const TrialRun&) = delete;
  TrialRun& operator=(const TrialRun&) = delete;

  Result<std::string> Run() {
    auto outcome = Attempt();
    if (outcome) return outcome;
    if (context_.console.interrupted()) {
      CutShort(records::kInterrupted, outcome.error());
      return outcome;
    }
    CutShort(records::kBrokenOff, outcome.error());
    return Error{outcome.error().kind,
                 outcome.error().message +
                     "; this attempt does not count. Put that right, then run the same command"};
  }

 private:
  Result<std::string> Attempt() {
    if (const auto done = Begin(); !done) return done.error();
    const auto reason = Wait();
    if (!reason) return reason.error();
    if (const auto back = AwaitLinks(); !back) return back.error();
    if (const auto done = Stop(); !done) return done.error();
    // The finish line may have come between the reason and the stop.
    const std::string outcome = events_.tracker().Outcome(*reason);
    if (const auto done = Finish(outcome); !done) return done.error();
    return outcome;
  }

  bool Synthetic() const {
    return context_.options.unattended ||
           gate::AnySimulated({phase_.interface, context_.protocol.settings.turn_by},
                              servers_.devices());
  }

  ordered_json Marks() const {
    return {{"trial", id_},
            {"phase", phase_.id},
            {"interface", phase_.interface},
            {"kind", Name(phase_.kind)},
            {"track", phase_.track},
            {"task", phase_.task},
            {"seed", phase_.seed},
            {"attempt", attempt_},
            {"recording", file_},
            {"synthetic", Synthetic()}};
  }

  mcap::TextMap MarksOfRecording() const {
    mcap::TextMap marks = ToTextMap(Marks());
    marks["participant"] = context_.session.participant;
    std::string order;
    for (const std::string& one : context_.session.interfaces) {
      order += (order.empty() ? "" : " ") + one;
    }
    marks["order"] = order;
    marks["study_seed"] = std::to_string(context_.protocol.seed);
    return marks;
  }

  Result<void> Begin() {
    // First of all: an attempt of which anything is left, such as a recording, has its number.
    if (const auto done = context_.journal.Append(EventKind::kTrialStarted, Marks()); !done) {
      return done;
    }
    begun_ = true;
    begin_ns_ = complete_ns_ = clock::MonotonicNs();
    TrialRecorder::Options recording;
    recording.path =
        journal::ParticipantFolder(context_.options.study_folder, context_.session.participant) +
        "/" + file_;
    recording.version = context_.options.version;
    recording.addresses = {context_.options.sensor, context_.options.simulation};
    recording.attachments = {{"protocol.json", context_.options.protocol_text}};
    auto recorder =
        TrialRecorder::Begin(context_.console, std::move(recording), MarksOfRecording());
    if (!recorder) return recorder.error();
    recorder_ = std::move(*recorder);
    if (const auto first = recorder_->AwaitFirst(context_.console); !first) return first;
    events_.Begin();
    begin_ns_ = complete_ns_ = clock::MonotonicNs();
    if (const auto done = servers_.Call(StartCommand(id_, phase_)); !done) return done;
    on_placed_();
    if (!context_.options.unattended) {
      context_.console.ReadKeys(true);
      context_.console.Print(id_ + " on track " + phase_.track +
                             (phase_.task.empty() ? "" : ", task " + phase_.task) +
                             ". Keys: s stops the trial, u undoes the latest failure.");
    }
    return {};
  }

  /// Until the finish line, the time limit, a key, or the end by another console: the outcome, but
  /// for a finish line that is crossed before the trial is stopped.
  Result<std::string> Wait() {
    const std::int64_t end_ns = begin_ns_ + SecondsToNanoseconds(context_.protocol.trial_limit_s);
    for (;;) {
      std::optional<char> key;
      const Waited waited = context_.console.RunUntil(
          [&] {
            if (!context_.options.unattended) key = context_.console.TakeKey();
            return key || events_.tracker().over() || !events_.written() || !recorder_->written() ||
                   servers_.broken() || DeviceLost();
          },
          std::max(0.0, NanosecondsToSeconds(end_ns - clock::MonotonicNs())));
      if (waited == Waited::kInterrupted) return Interrupted();
      if (!events_.written()) return events_.written().error();
      if (!recorder_->written()) return recorder_->written().error();
      if (events_.tracker().over()) return events_.tracker().Outcome("stopped");
      if (waited == Waited::kTimeUp) return std::string("timed_out");
      if (servers_.broken()) return Failure("the trial broke off: " + servers_.WhyNotLive());
      if (DeviceLost()) return std::string(records::kDeviceLost);
      if (key == 's') return std::string("stopped");
      if (key == 'u') {
        if (const auto done = UndoNewest(context_, servers_, id_); !done) return done.error();
      }
    }
  }

  /// A connection that is down at the end holds events of the trial back.
  Result<void> AwaitLinks() {
    const auto decided = [&] { return servers_.live() || servers_.broken(); };
    if (context_.console.RunUntil(decided, kLinksWithinS) == Waited::kInterrupted) {
      return Interrupted();
    }
    return servers_.live() ? Result<void>()
                           : Failure("the trial broke off: " + servers_.WhyNotLive());
  }

  /// A device that the interface needs has sent nothing for a while.
  bool DeviceLost() {
    const std::uint32_t missing_roles = servers_.frame().interface.missing_roles;
    const std::int64_t now_ns = clock::MonotonicNs();
    if (missing_roles == 0) complete_ns_ = now_ns;
    if (missing_roles != 0) lost_roles_ = missing_roles;
    return NanosecondsToSeconds(now_ns - complete_ns_) > kDeviceBackS;
  }

  /// Unless it is over; returns when it is.
  Result<void> Stop() {
    const auto over = [&] { return events_.tracker().over(); };
    if (over()) return {};
    v1::Command command;
    command.mutable_stop_trial()->set_character(1);
    command.mutable_stop_trial()->set_trial(id_);
    const auto stopped = servers_.Call(std::move(command));
    const Waited waited = context_.console.RunUntil(over, kConfirmedWithinS);
    if (waited == Waited::kInterrupted) return Interrupted();
    // A trial that another console has begun meanwhile refuses it, and ends this one.
    return waited == Waited::kTimeUp ? stopped : Result<void>();
  }

  Result<void> Finish(const std::string& outcome) {
    ordered_json fields = {{"trial", id_},
                           {"outcome", outcome},
                           {"wall_s", NanosecondsToSeconds(clock::MonotonicNs() - begin_ns_)},
                           {"active_s", active_.seconds() - active_before_s_}};
    fields.update(events_.Figures());
    if (const auto breaks = servers_.breaks() - breaks_before_; breaks > 0) {
      fields["link_breaks"] = breaks;
    }
    events_.End();
    if (outcome == records::kDeviceLost) {
      fields["device"] = stream::RoleNames(lost_roles_);
      const auto interface = stream::UserInterfaceNamed(phase_.interface);
      context_.console.Print("No signal from " + stream::DevicesText(interface, lost_roles_) +
                             ". Press a button of it; if no light comes on, change its batteries.");
    }
    if (recorder_->CatchUp(context_.console, servers_.frame().host_ns) == Waited::kInterrupted) {
      return Interrupted();
    }
    if (const auto done = recorder_->Finish(ToTextMap(fields)); !done) return done;
    return context_.journal.Append(EventKind::kTrialFinished, std::move(fields));
  }

  /// A server, the lease or the recording is gone, or the program is interrupted: marks the
  /// attempt, as far as that still works.
  void CutShort(const char* outcome, const Error& why) {
    if (!begun_) return;
    ordered_json fields = {{"trial", id_},
                           {"outcome", outcome},
                           {"reason", why.message},
                           {"active_s", active_.seconds() - active_before_s_},
                           {"wall_s", NanosecondsToSeconds(clock::MonotonicNs() - begin_ns_)}};
    fields.update(events_.Figures());
    if (recorder_) {
      const auto done = recorder_->Finish(ToTextMap(fields));
      if (!done && done.error().message != why.message) {
        context_.console.Print(done.error().message);
      }
    }
    const auto noted = context_.journal.Append(EventKind::kTrialFinished, std::move(fields));
    if (!noted) context_.console.Print(noted.error().message);
  }

  SessionContext& context_;
  Servers& servers_;
  const ActiveTime& active_;
  double active_before_s_;
  std::uint64_t breaks_before_;
  const plan::Phase& phase_;
  std::size_t attempt_;
  std::string id_, file_;
  std::unique_ptr<TrialRecorder> recorder_;
  bool begun_ = false;  ///< The journal has its start.
  std::int64_t begin_ns_ = 0;
  std::int64_t complete_ns_ = 0;  ///< When all devices were last there.
  std::uint32_t lost_roles_ = 0;
  TrialEvents& events_;
  std::function<void()> on_placed_;
};

}  // namespace

Result<std::string> RunTrial(SessionContext& context, Servers& servers, const ActiveTime& active,
                             TrialEvents& events, const plan::Phase& phase, std::size_t attempt,
                             std::function<void()> on_placed) {
  return TrialRun(context, servers, active, events, phase, attempt, std::move(on_placed)).Run();
}

Result<void> PlaceOnTrack(Servers& servers, const std::string& id, const plan::Phase& phase) {
  return servers.Call(StartCommand(id, phase));
}

}  // namespace footing::study
