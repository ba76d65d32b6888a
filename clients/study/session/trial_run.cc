#include "clients/study/session/trial_run.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "clients/study/plan/device_gate.h"
#include "clients/study/report/trials.h"
#include "clients/study/session/journal.h"
#include "common/base/text.h"
#include "common/base/units.h"
#include "common/runtime/clock.h"
#include "common/stream/response.h"
#include "common/wire/wire.h"

namespace footing::study {

void Anticipation::Add(const Sight& frame) {
  const bool now_commanded = frame.commanded == frame.wanted;
  const bool now_ahead = frame.to_mark_m > 0;
  if (now_ahead && !ahead_) answered_ = now_commanded;  // A new approach.
  if (!now_ahead && ahead_) {
    line_ns_ = frame.host_ns;
    const bool in_force = commanded_ || frame.running == frame.wanted;
    if (!in_force) {
      command_ns_ = 0;
      answered_ = false;
    }
  }
  if (now_commanded && !commanded_ && (now_ahead || !answered_)) {
    command_ns_ = frame.host_ns;
    answered_ = true;
  }
  commanded_ = now_commanded;
  ahead_ = now_ahead;
}

std::optional<double> Anticipation::seconds() const {
  if (command_ns_ == 0 || line_ns_ == 0) return std::nullopt;
  return NanosecondsToSeconds(line_ns_ - command_ns_);
}

bool TrialTracker::Add(const stream::TrialState& frame) {
  if (frame.trial != trial_) {
    replaced_ = replaced_ || begun();  // Before the first frame of its own it is that of another.
    return false;
  }
  state_ = frame;
  return true;
}

bool TrialTracker::over() const {
  return finished() || replaced_ || state_.progress.phase == stream::TrialPhase::kStopped;
}

std::string TrialTracker::Outcome(const std::string& reason) const {
  return finished() ? "finished" : reason;
}

namespace {

using nlohmann::ordered_json;
using records::EventKind;

/// Gait wanted by the task with that name; kUnspecified: the track has none.
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
  // A task that was never done has no anticipation.
  const auto anticipation_s = anticipation_.seconds();
  if (fields["task_done"] && anticipation_s) fields["anticipation_s"] = *anticipation_s;
  return fields;
}

namespace {

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

namespace {

constexpr auto kFlushPeriod = std::chrono::milliseconds(400);  // Half of kLongestUnwrittenNs.
constexpr double kFirstTickS = 5;
constexpr double kCaughtUpS = 1;

}  // namespace

Result<std::unique_ptr<TrialRecorder>> TrialRecorder::Begin(Console& console,
                                                            const Options& options,
                                                            const mcap::TextMap& marks) {
  recording::WriterSettings settings;
  settings.chunks.compress = true;
  settings.library = "footing-study " + options.version;
  auto writer = recording::RecordingWriter::Create(options.path, settings);
  if (!writer) return writer.error();
  auto own = std::unique_ptr<TrialRecorder>(new TrialRecorder(console, std::move(*writer)));
  if (const auto done = own->Describe(options, marks); !done) return done.error();
  for (const transport::Address& address : options.addresses) {
    recording::ServerRecorderOptions server;
    server.address = address;
    server.client_name = "footing-study";
    server.on_written = [&self = *own](Result<void> written) { self.Keep(std::move(written)); };
    own->servers_.push_back(std::make_unique<recording::ServerRecorder>(
        console.io(), own->writer_, own->names_, std::move(server)));
  }
  for (const auto& server : own->servers_) server->Start();
  own->FlushLater();
  return own;
}

TrialRecorder::~TrialRecorder() {
  for (const auto& server : servers_) server->Stop();
}

Result<void> TrialRecorder::Describe(const Options& options, const mcap::TextMap& marks) {
  if (const auto done = writer_.AddMetadata("trial", marks); !done) return done;
  for (const auto& [name, text] : options.attachments) {
    const auto done = writer_.Attach(name, "application/json", text, clock::MonotonicNs());
    if (!done) return done;
  }
  return recording::DescribeRecording(writer_, "footing-study", options.version, options.addresses);
}

template <typename Does>
bool TrialRecorder::EveryServer(const Does& does) const {
  return !written_ || std::all_of(servers_.begin(), servers_.end(),
                                  [&](const auto& server) { return does(server->recorder()); });
}

Result<void> TrialRecorder::AwaitFirst(Console& console) const {
  const auto flows = [](const recording::StreamRecorder& recorder) { return recorder.ticks() > 1; };
  const Waited waited = console.RunUntil([&] { return EveryServer(flows); }, kFirstTickS);
  if (waited == Waited::kInterrupted) return Interrupted();
  if (waited == Waited::kTimeUp) {
    return NoDevice("nothing comes to record in " + writer_.path() + "; are both servers running?");
  }
  return written_;
}

Waited TrialRecorder::CatchUp(Console& console, std::int64_t host_ns) const {
  const auto has = [host_ns](const recording::StreamRecorder& recorder) {
    return recorder.last_host_ns() >= host_ns;
  };
  return console.RunUntil([&] { return EveryServer(has); }, kCaughtUpS);
}

void TrialRecorder::Keep(Result<void> written) {
  if (!written && written_) written_ = std::move(written);
}

void TrialRecorder::FlushLater() {
  flush_.After(kFlushPeriod, [this] {
    if (writer_.pending() && written_) Keep(writer_.Flush());
    FlushLater();
  });
}

Result<void> TrialRecorder::Finish(const mcap::TextMap& outcome) {
  flush_.cancel();
  for (const auto& server : servers_) {
    server->Stop();
    Keep(server->End());
  }
  if (!written_) return written_;
  if (const auto done = writer_.AddMetadata("trial_outcome", outcome); !done) return done;
  return writer_.Finish();
}

namespace {

constexpr double kCorrectedWithinS = 2;

Result<void> Withdraw(Servers& servers, std::uint64_t number) {
  v1::Command command;
  command.mutable_correct_failure()->set_failure(number);
  command.mutable_correct_failure()->set_reason("undone by the experimenter");
  return servers.Call(std::move(command));
}

std::vector<records::Failure> FailuresOf(const SessionContext& context, const std::string& trial) {
  return records::FailuresOf(records::Collect(context.journal.events()), trial);
}

bool Counts(const SessionContext& context, const std::string& trial, std::uint64_t number) {
  for (const records::Failure& one : FailuresOf(context, trial)) {
    if (one.number == number) return !one.undone;
  }
  return false;
}

}  // namespace

Result<void> UndoFailure(SessionContext& context, Servers& servers, const std::string& trial,
                         std::uint64_t number) {
  const std::string text = "failure " + std::to_string(number);
  if (!Counts(context, trial, number)) {
    context.console.Print(trial + " has no " + text + " that counts");
    return {};
  }
  if (servers.frame().trial.trial != trial) {
    context.console.Print(text + " undone");
    return context.journal.Append(records::EventKind::kFailureUndone,
                                  {{"trial", trial}, {"failure", number}});
  }
  const auto sent = Withdraw(servers, number);
  if (context.console.interrupted()) return Interrupted();
  if (!sent) {
    context.console.Print(sent.error().message);
    return {};
  }
  const Waited waited =
      context.console.RunUntil([&] { return !Counts(context, trial, number); }, kCorrectedWithinS);
  if (waited == Waited::kInterrupted) return Interrupted();
  if (waited == Waited::kTimeUp) {
    context.console.Print("footing-sim has not confirmed the correction of " + text);
  }
  return {};
}

Result<void> UndoNewest(SessionContext& context, Servers& servers, const std::string& trial) {
  const std::vector<records::Failure> failures = FailuresOf(context, trial);
  for (auto one = failures.rbegin(); one != failures.rend(); ++one) {
    if (!one->undone) return UndoFailure(context, servers, trial, one->number);
  }
  context.console.Print("no failure to undo");
  return {};
}

}  // namespace footing::study
