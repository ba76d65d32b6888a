#include "clients/study/session/run_session.h"

#include <unistd.h>

#include <utility>

#include "clients/study/session/lock.h"
#include "clients/study/session/study_folder.h"
#include "clients/study/report/trials.h"
#include "clients/study/session/survey_screen.h"
#include "common/cli/cli.h"
#include "common/runtime/clock.h"
#include "common/base/number.h"

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
  journal::Lock lock;  ///< Of the participant's folder.
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

Result<plan::Session> SessionOf(const SessionOptions& options, const plan::Protocol& protocol) {
  for (plan::Session& session : plan::MakeSessions(protocol)) {
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

/// What the participant sees at the beginning of a phase.
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

}  // namespace footing::study
