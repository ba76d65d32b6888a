#include "clients/study/session/run_session.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <unistd.h>

#include "clients/study/plan/device_gate.h"
#include "clients/study/report/trials.h"
#include "clients/study/session/journal.h"
#include "clients/study/session/survey.h"
#include "clients/study/session/trial_run.h"
#include "common/base/text.h"
#include "common/base/units.h"
#include "common/cli/cli.h"
#include "common/runtime/clock.h"

namespace footing::study {
namespace {

using nlohmann::ordered_json;
using records::EventKind;

std::string Holder(const SessionOptions& options) {
  return cli::UserAtHost() + ", footing-study process " + std::to_string(::getpid()) +
         ", participant " + options.participant;
}

/// Everything that must be there before an event can be appended.
struct Opened {
  journal::Lock lock;  ///< Lock on the participant's folder.
  journal::Journal journal;
};

/// The journal of a participant whose folder is there: nobody else writes into it.
Result<Opened> OpenJournal(const SessionOptions& options) {
  const std::string own = journal::ParticipantFolder(options.study_folder, options.participant);
  auto lock =
      journal::Lock::Take(own + "/lock", "the session of " + options.participant, Holder(options));
  if (!lock) return lock.error();
  const std::string path = journal::JournalPath(options.study_folder, options.participant);
  auto journal =
      journal::Exists(path) ? journal::Journal::Resume(path) : journal::Journal::Create(path);
  if (!journal) return journal.error();
  const auto same = journal::RequireParticipant(journal->events(), options.participant, path);
  if (!same) return same.error();
  return Opened{std::move(*lock), std::move(*journal)};
}

/// One session at a time runs in a study: participants share devices and the character.
Result<journal::Lock> LockStudy(const SessionOptions& options) {
  const std::string& folder = options.study_folder;
  auto lock = journal::Lock::Take(folder + "/lock", "the study", Holder(options));
  if (!lock) return lock;
  if (options.unattended) {
    if (const auto done = journal::RequireNoPerson(folder); !done) return done.error();
  }
  if (const auto done = journal::KeepProtocol(folder, options.protocol_text); !done) {
    return done.error();
  }
  const auto done = journal::MakeFolder(journal::ParticipantFolder(folder, options.participant));
  return done ? std::move(lock) : Result<journal::Lock>(done.error());
}

Result<plan::SessionPlan> SessionOf(const SessionOptions& options, const plan::Protocol& protocol) {
  for (plan::SessionPlan& session : plan::MakeSessions(protocol)) {
    if (session.participant == options.participant) return std::move(session);
  }
  return UsageError("participant " + options.participant +
                    " is not in the protocol; add the code at the end of participants");
}

Result<void> NoteStart(SessionContext& context, const records::Progress& progress) {
  const SessionOptions& options = context.options;
  if (!progress.started) {
    return context.journal.Append(
        EventKind::kSessionStarted,
        {{"participant", options.participant},
         {"study", context.protocol.name},
         {"study_seed", context.protocol.seed},
         {"interfaces", context.session.interfaces},
         {"turn_by", context.protocol.settings.turn_by},
         {"synthetic", options.unattended},
         {"simulated_time", clock::OwnFollower() != nullptr},
         {"answer_seed", options.unattended ? ordered_json(options.answer_seed) : ordered_json()},
         {"version", options.version}});
  }
  return context.journal.Append(EventKind::kSessionResumed,
                                {{"version", options.version},
                                 {"synthetic", options.unattended},
                                 {"torn_bytes", context.journal.torn_bytes()},
                                 {"interrupted_trial", progress.interrupted_trial}});
}

/// Whether any of the phases from `first` on needs footing-sim.
bool NeedServers(const std::vector<plan::Phase>& phases, std::size_t first) {
  for (std::size_t i = first; i < phases.size(); ++i) {
    if (phases[i].kind == plan::PhaseKind::kDeviceCheck || !phases[i].track.empty()) return true;
  }
  return false;
}

const char* PhaseText(plan::PhaseKind kind) {
  switch (kind) {
    case plan::PhaseKind::kConsent:
      return "Confirm the consent.";
    case plan::PhaseKind::kDeviceCheck:
      return "Checking the devices.";
    case plan::PhaseKind::kRest:
      return "Rest.";
    case plan::PhaseKind::kDemonstration:
      return "Show all commands.";
    case plan::PhaseKind::kRanges:
      return "Measure the participant's own ranges.";
    case plan::PhaseKind::kPractice:
      return "Practice.";
    case plan::PhaseKind::kStraight:
    case plan::PhaseKind::kTestTrack:
      return "A trial comes next.";
    case plan::PhaseKind::kSurvey:
    case plan::PhaseKind::kFinalSurvey:
      return "The participant answers the survey.";
  }
  return "";
}

/// Activity that the participant sees at the beginning of a phase.
stream::StudyActivity ActivityOf(plan::PhaseKind kind) {
  switch (kind) {
    case plan::PhaseKind::kConsent:
    case plan::PhaseKind::kDeviceCheck:
      return stream::StudyActivity::kWait;
    case plan::PhaseKind::kRest:
      return stream::StudyActivity::kRest;
    case plan::PhaseKind::kDemonstration:
      return stream::StudyActivity::kDemonstration;
    case plan::PhaseKind::kRanges:
      return stream::StudyActivity::kRanges;
    case plan::PhaseKind::kPractice:
      return stream::StudyActivity::kPractice;
    case plan::PhaseKind::kStraight:
    case plan::PhaseKind::kTestTrack:
      return stream::StudyActivity::kGetReady;
    case plan::PhaseKind::kSurvey:
    case plan::PhaseKind::kFinalSurvey:
      return stream::StudyActivity::kSurvey;
  }
  return stream::StudyActivity::kUnspecified;
}

}  // namespace

SessionRun::SessionRun(SessionContext context)
    : context_(context),
      progress_(records::Replay(context.session.phases, context.journal.events())) {}

Result<void> SessionRun::Run() {
  Console& console = context_.console;
  if (progress_.finished || progress_.withdrawn) {
    return UsageError(Describe(progress_, context_.session) + "; a session is never run again");
  }
  if (progress_.started) {
    console.Print(Describe(progress_, context_.session) + "; the session resumes there");
  }
  if (context_.journal.torn_bytes() > 0) {
    console.Print("the last line of " + context_.journal.path() + " was torn (" +
                  std::to_string(context_.journal.torn_bytes()) + " bytes) and is dropped");
  }
  const std::vector<plan::Phase>& phases = context_.session.phases;
  if (NeedServers(phases, progress_.next_phase)) {
    // Before anything is noted: who leads another session on this footing-sim goes on with it.
    if (const auto servers = Connect(); !servers) return servers.error();
  }
  if (const auto done = NoteStart(context_, progress_); !done) return done;
  for (std::size_t i = progress_.next_phase; i < phases.size(); ++i) {
    shown_ = {.study = context_.protocol.name,
              .participant = context_.session.participant,
              .interface = phases[i].interface,
              .phase = phases[i].id,
              .number = static_cast<std::uint32_t>(i + 1),
              .phases = static_cast<std::uint32_t>(phases.size()),
              .doing = "",
              .next = i + 1 < phases.size() ? phases[i + 1].id : "the end of the session",
              .keys = ""};
    // Until the device check of a phase that uses them, and after it.
    if (servers_) servers_->LendDevices();
    if (const auto done = RestWhereDue(phases[i]); !done) return done;
    ordered_json fields = {{"phase", phases[i].id},
                           {"kind", Name(phases[i].kind)},
                           {"interface", phases[i].interface}};
    if (const auto done = context_.journal.Append(EventKind::kPhaseStarted, fields); !done) {
      return done;
    }
    console.Print("[" + std::to_string(i + 1) + "/" + std::to_string(phases.size()) + "] " +
                  phases[i].id +
                  ", active so far: " + text::Fixed(ActiveS() / kSecondsPerMinute, 1) + " min");
    Show(ActivityOf(phases[i].kind), PhaseText(phases[i].kind), "");
    const double active_before_s = active_.seconds();
    if (const auto done = RunPhase(phases[i]); !done) return done;
    if (console.interrupted()) return Interrupted();
    fields["active_s"] = active_.seconds() - active_before_s;
    if (const auto done = context_.journal.Append(EventKind::kPhaseFinished, fields); !done) {
      return done;
    }
  }
  return context_.journal.Append(EventKind::kSessionFinished, ordered_json::object());
}

void SessionRun::Show(stream::StudyActivity activity, const std::string& doing,
                      const std::string& keys, double left_s) {
  const std::string warning = RestWarning();
  if (!warning.empty() && warned_.insert(kRestWarning).second) context_.console.Print(warning);
  shown_.doing = doing + (warning.empty() ? "" : " " + warning);
  shown_.activity = activity;
  shown_.keys = keys;
  shown_.left_s = left_s;
  shown_.active_s = ActiveS();
  if (servers_) servers_->Show(shown_);
}

Result<void> RunSession(const SessionOptions& options, const plan::Protocol& protocol) {
  const auto session = SessionOf(options, protocol);
  if (!session) return session.error();
  // Before anything is written.
  if (const auto done = journal::MakeFolder(options.study_folder); !done) return done;
  const auto space = journal::RequireSpace(options.study_folder, protocol.disk_mb);
  if (!space) return space.error();
  const auto lock = LockStudy(options);
  if (!lock) return lock.error();
  auto opened = OpenJournal(options);
  if (!opened) return opened.error();
  Console console;
  std::unique_ptr<SurveyScreen> screen;
  if (options.survey) {
    auto open = SurveyScreen::Open(console, *options.survey);
    if (!open) return open.error();
    screen = std::move(*open);
    console.Print("The participant's screen: footing-study survey --connect " +
                  screen->address().Text());
  }
  return SessionRun({options, protocol, *session, console, opened->journal, screen.get()}).Run();
}

Result<void> AppendToSession(const SessionOptions& options, const plan::Protocol& protocol,
                             EventKind kind, ordered_json fields) {
  if (const auto session = SessionOf(options, protocol); !session) return session.error();
  const std::string path = journal::JournalPath(options.study_folder, options.participant);
  if (!journal::Exists(path))
    return UsageError("participant " + options.participant + " has no session yet: " + path +
                      " is missing");
  const auto same = journal::CheckProtocol(options.study_folder, options.protocol_text);
  if (!same) return same.error();
  auto opened = OpenJournal(options);
  if (!opened) return opened.error();
  if (fields.contains("failure")) {
    const records::Records records = records::Collect(opened->journal.events());
    const std::uint64_t number = fields["failure"];
    const records::Trial* trial = records::WithFailure(records, number);
    if (trial == nullptr) {
      return UsageError("no trial of participant " + options.participant + " has failure " +
                        std::to_string(number) + "; " + path + " has their numbers");
    }
    fields["trial"] = trial->id;
  }
  return opened->journal.Append(kind, std::move(fields));
}

namespace {

using stream::StudyActivity;

constexpr const char* kFinished = "finished";  // The outcome of a trial at its finish line.
constexpr double kCountInS = 3;                // The participant's screen counts 3, 2, 1.
constexpr double kDevicesReadyS = 10;  // A rate is known a few seconds after a device attached.
constexpr double kSaidAfterS = 0.5;    // The lease and the first status take less.

}  // namespace

Result<void> SessionRun::RunPhase(const plan::Phase& phase) {
  const std::string& interface =
      phase.interface.empty() ? context_.session.interfaces.front() : phase.interface;
  switch (phase.kind) {
    case plan::PhaseKind::kConsent:
      return Consent();
    case plan::PhaseKind::kDeviceCheck:
      return CheckDevices(interface);
    case plan::PhaseKind::kRest:
      return Rest("Rest", phase.duration_s);
    case plan::PhaseKind::kDemonstration:
      return Demonstrate(phase);
    case plan::PhaseKind::kRanges:
      return MeasureRanges(phase);
    case plan::PhaseKind::kPractice:
      return Practise(phase);
    case plan::PhaseKind::kStraight:
    case plan::PhaseKind::kTestTrack: {
      const auto done = Trial(phase);
      events_.reset();
      return done;
    }
    case plan::PhaseKind::kSurvey:
      return RunSurvey(context_, plan::ItemsAfter(context_.protocol, phase.interface));
    case plan::PhaseKind::kFinalSurvey:
      return RunSurvey(context_, plan::ItemsAtEnd(context_.protocol, context_.session.interfaces));
  }
  return {};
}

Result<void> SessionRun::Consent() {
  const auto note = [&](const std::string& text) {
    return context_.journal.Append(EventKind::kNote,
                                   {{"text", text}, {"synthetic", context_.options.unattended}});
  };
  if (context_.options.unattended)
    return note("no person takes part: " + context_.protocol.consent);
  const auto answer = context_.console.Ask(
      context_.protocol.consent + "\nType yes to confirm; anything else ends the session:");
  if (!answer) return answer.error();
  if (*answer != "yes") return Failure("without consent the session ends here");
  return note("confirmed: " + context_.protocol.consent);
}

Result<void> SessionRun::CheckDevices(const std::string& interface) {
  const auto servers = Connect();
  if (!servers) return servers.error();
  plan::DeviceGate gate = context_.protocol.devices;
  gate.allow_simulated = gate.allow_simulated || context_.options.unattended;
  const plan::Played played{interface, context_.protocol.settings.turn_by};
  const auto problems = [&] {
    auto all = gate::Problems(gate, played, (*servers)->devices());
    if (const auto why = (*servers)->WhyNoDevices(); !why.empty()) all.push_back(why);
    return all;
  };
  const auto ready = [&] { return problems().empty(); };
  const auto say = [&](const std::string& what, const std::string& keys) {
    const std::vector<std::string> now = problems();
    context_.console.Print(what + ": " + text::Joined(now, "; "));
    const std::string more =
        now.size() > 1 ? "; and " + std::to_string(now.size() - 1) + " more, see the terminal" : "";
    Show(StudyActivity::kWait, what + ": " + (now.empty() ? "" : now.front()) + more, keys);
  };
  for (;;) {
    (*servers)->KeepDevices();
    Waited waited = context_.console.RunUntil(ready, kSaidAfterS);
    if (waited == Waited::kTimeUp) {
      say("Waiting for the devices", "");
      waited = context_.console.RunUntil(ready, kDevicesReadyS - kSaidAfterS);
    }
    if (waited == Waited::kInterrupted) return Interrupted();
    if (waited == Waited::kDone) return Warn(gate::Warnings(played, (*servers)->devices()));
    if (context_.options.unattended) {
      return NoDevice("the devices are not ready: " + text::Joined(problems(), "; "));
    }
    say("The devices are not ready", "Enter checks again");
    (*servers)->LendDevices();  // The remedy may be a command to footingd.
    const auto again = context_.console.Ask("Press Enter to check again:");
    if (!again) return again.error();
  }
}

Result<void> SessionRun::Warn(const std::vector<std::string>& warnings) {
  for (const std::string& warning : warnings) {
    if (!warned_.insert(warning).second) continue;
    context_.console.Print("Warning: " + warning);
    const auto done = context_.journal.Append(EventKind::kNote, {{"text", "warning: " + warning}});
    if (!done) return done;
  }
  return {};
}

Result<void> SessionRun::Demonstrate(const plan::Phase& phase) {
  const auto servers = UseInterface(phase.interface);
  if (!servers) return servers.error();
  const auto placed = PlaceOnTrack(**servers, context_.session.participant + "." + phase.id, phase);
  if (!placed || context_.options.unattended) return placed;
  Show(StudyActivity::kDemonstration, "Show all commands of " + phase.interface + ".",
       "Enter: done");
  const auto done = context_.console.Ask("Interface " + phase.interface +
                                         ": show all commands. Press Enter when done:");
  return done ? Result<void>() : done.error();
}

Result<void> SessionRun::Practise(const plan::Phase& phase) {
  const auto servers = UseInterface(phase.interface);
  if (!servers) return servers.error();
  const auto placed = PlaceOnTrack(**servers, context_.session.participant + "." + phase.id, phase);
  if (!placed) return placed;
  return CountDown(StudyActivity::kPractice, "Practice of " + phase.interface, phase.duration_s,
                   /*may_end_early=*/true);
}

Result<void> SessionRun::Trial(const plan::Phase& phase) {
  const bool attended = !context_.options.unattended;
  if (const auto before = progress_.outcomes.find(phase.id); before != progress_.outcomes.end()) {
    context_.console.Print(phase.id + " has ended before: " + before->second);
    shown_.attempt = static_cast<std::uint32_t>(progress_.attempts[phase.id]);
    if (!attended) return {};
    const auto repeat = AskToRepeat(phase, before->second);
    if (!repeat) return repeat.error();
    if (!*repeat) return {};
  }
  for (;;) {
    const auto outcome = Attempt(phase);
    if (!outcome) return outcome.error();
    if (*outcome == records::kDeviceLost) {
      if (!attended) {
        return NoDevice("a device was lost in " + phase.id +
                        ", which does not count; connect it and run the same command again: the "
                        "session goes on with this trial");
      }
      context_.console.Print("This attempt does not count.");
      continue;
    }
    if (!attended) return {};
    const auto repeat = AskToRepeat(phase, *outcome);
    if (!repeat) return repeat.error();
    if (!*repeat) return {};
  }
}

Result<std::string> SessionRun::Attempt(const plan::Phase& phase) {
  const auto space = journal::RequireSpace(
      context_.options.study_folder,
      context_.protocol.disk_mb / static_cast<double>(context_.session.trial_count()));
  if (!space) return space.error();
  const std::size_t attempt = progress_.attempts[phase.id] + 1;
  shown_.attempt = static_cast<std::uint32_t>(attempt);
  const bool attended = !context_.options.unattended;
  if (attended) {
    const std::string where =
        "track " + phase.track + (phase.task.empty() ? "" : ", task " + phase.task) + ".";
    Show(StudyActivity::kGetReady, "Next: " + where, "Enter begins the trial");
    const auto ready =
        context_.console.Ask("Next: " + phase.id + ", " + where + " Press Enter to begin:");
    if (!ready) return ready.error();
  }
  const auto servers = UseInterface(phase.interface);
  if (!servers) return servers.error();
  progress_.attempts[phase.id] = attempt;
  Show(StudyActivity::kGetReady, "The trial begins.", "");
  events_.reset();
  events_ = std::make_unique<TrialEvents>(
      context_, **servers,
      context_.session.participant + "." + phase.id + "." + std::to_string(attempt));
  const auto outcome =
      RunTrial(context_, **servers, active_, *events_, phase, attempt, [this, attended] {
        Show(StudyActivity::kTrial, "The trial is running.",
             "s stops it, u undoes the latest failure", attended ? kCountInS : 0);
      });
  if (!outcome) return outcome.error();
  const stream::TrialProgress& trial = (*servers)->frame().trial.progress;
  context_.console.Print(phase.id + ": " + *outcome + ", " + text::Fixed(trial.time_s, 1) +
                         " s, failures: " + std::to_string(stream::Total(trial.failures)));
  return outcome;
}

Result<bool> SessionRun::AskToRepeat(const plan::Phase& phase, const std::string& outcome) {
  Show(outcome == kFinished ? StudyActivity::kFinished : StudyActivity::kStopped,
       "The trial is over.", "Enter continues, r repeats it, u NUMBER undoes a failure");
  for (;;) {
    const auto next = context_.console.Ask(
        "Press Enter to continue, type r to repeat the trial, or u NUMBER to undo a failure:");
    if (!next) return next.error();
    if (next->empty()) return false;
    if (*next == "r") return true;
    const auto number = next->starts_with("u ") ? text::ToCount(next->substr(2)) : std::nullopt;
    if (!number) {
      context_.console.Print(text::Quoted(*next) +
                             " is none of these; nothing was changed (u 2 undoes failure 2)");
      continue;
    }
    if (const auto done = Undo(phase, *number); !done) return done.error();
  }
}

Result<void> SessionRun::Undo(const plan::Phase& phase, std::uint64_t failure) {
  const auto servers = Connect();
  if (!servers) return servers.error();
  const records::Records records = records::Collect(context_.journal.events());
  for (const records::Trial* trial : records::Counting(records)) {
    if (trial->phase != phase.id) continue;
    if (!events_) {  // The session was interrupted, or the connection.
      events_ = std::make_unique<TrialEvents>(context_, **servers, trial->id);
      events_->Begin();
      events_->End();
    }
    return UndoFailure(context_, **servers, trial->id, failure);
  }
  return {};
}

Result<Servers*> SessionRun::Connect() {
  if (servers_) {
    if (const auto leased = servers_->CheckLeases(); !leased) return leased.error();
    if (servers_->live()) return servers_.get();
  }
  events_.reset();
  servers_.reset();
  // Without the process: after a crash the same session goes on with its lease.
  const Servers::Options servers_of = {
      context_.options.sensor, context_.options.simulation,
      cli::UserAtHost() + ", footing-study, participant " + context_.options.participant};
  auto servers = Servers::Open(context_.console, servers_of, active_);
  if (!servers) return servers.error();
  servers_ = std::move(*servers);
  servers_->Show(shown_);
  return servers_.get();
}

Result<Servers*> SessionRun::UseInterface(const std::string& interface) {
  if (const auto done = CheckDevices(interface); !done) return done.error();
  const auto servers = Connect();
  if (!servers) return servers.error();
  const auto table = TableToSend(interface);
  if (!table) return table.error();
  const auto done = (*servers)->UseInterface(interface, context_.protocol.settings.turn_by, *table);
  if (!done) return done.error();
  return servers;
}

namespace {

constexpr double kReminderS = 60;

}  // namespace

Result<void> SessionRun::CountDown(stream::StudyActivity activity, const std::string& what,
                                   double duration_s, bool may_end_early) {
  if (context_.options.unattended) return {};
  Console& console = context_.console;
  const std::int64_t begin_ns = clock::MonotonicNs();
  const auto passed_s = [&] { return NanosecondsToSeconds(clock::MonotonicNs() - begin_ns); };
  console.ReadKeys(true);
  bool early = false;
  const auto ended = [&] {
    const std::optional<char> key = console.TakeKey();
    return early = may_end_early && key == '\n';
  };
  while (!early && !console.interrupted() && passed_s() < duration_s) {
    Show(activity, what + ".", may_end_early ? "Enter ends it early" : "", duration_s - passed_s());
    console.Print(what + ": " + text::Fixed(std::ceil(duration_s - passed_s()), 0) + " s left." +
                  (may_end_early ? " Press Enter to end it early." : ""));
    console.RunUntil(ended, std::min(kReminderS, duration_s - passed_s()));
  }
  console.ReadKeys(false);
  if (console.interrupted()) return Interrupted();
  if (!early) return {};
  return context_.journal.Append(
      EventKind::kNote,
      {{"text", what + " ended early"}, {"planned_s", duration_s}, {"took_s", passed_s()}});
}

double SessionRun::ActiveS() const { return progress_.active_s + active_.seconds(); }

double SessionRun::UnrestedMin() const {
  return (ActiveS() - progress_.rested_at_s) / kSecondsPerMinute;
}

bool SessionRun::NeedsRest() const {
  return UnrestedMin() >= context_.protocol.rests.active_limit_min;
}

Result<void> SessionRun::RestWhereDue(const plan::Phase& next) {
  if (next.track.empty() || !NeedsRest()) return {};
  return Rest("Rest after " + text::Fixed(UnrestedMin(), 0) + " min in motion",
              context_.protocol.rests.after_limit_s);
}

Result<void> SessionRun::Rest(const std::string& what, double duration_s) {
  rests_ = true;
  const auto done =
      CountDown(stream::StudyActivity::kRest, what, duration_s, /*may_end_early=*/false);
  rests_ = false;
  if (!done || duration_s < context_.protocol.rests.after_limit_s) return done;
  progress_.rested_at_s = ActiveS();
  warned_.erase(kRestWarning);
  return context_.journal.Append(EventKind::kNote, {{"text", what},
                                                    {"took_s", duration_s},
                                                    {records::kRestedAt, progress_.rested_at_s},
                                                    {"synthetic", context_.options.unattended}});
}

std::string SessionRun::RestWarning() const {
  if (rests_ || !NeedsRest()) return "";
  return "The participant has moved for " + text::Fixed(UnrestedMin(), 0) + " min: a rest of " +
         text::Fixed(context_.protocol.rests.after_limit_s / kSecondsPerMinute, 0) +
         " min comes next.";
}

}  // namespace footing::study
