#include <algorithm>
#include <cmath>
#include <optional>

#include "clients/study/plan/device_gate.h"
#include "clients/study/session/study_folder.h"
#include "clients/study/report/trials.h"
#include "clients/study/session/run_session.h"
#include "clients/study/session/survey.h"
#include "clients/study/session/trial_run.h"
#include "clients/study/session/undo.h"
#include "common/cli/cli.h"
#include "common/runtime/clock.h"
#include "common/base/joined.h"
#include "common/base/lines.h"
#include "common/base/number.h"
#include "common/base/units.h"

namespace footing::study {
namespace {

using nlohmann::ordered_json;
using records::EventKind;
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

}  // namespace footing::study
