#include "clients/study/simulate_study.h"

#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <map>
#include <optional>

#include "clients/study/session/journal.h"
#include "clients/study/session/lock.h"
#include "clients/study/session/study_folder.h"
#include "clients/study/progress_text.h"
#include "clients/study/simulated_session.h"
#include "common/cli/cli.h"
#include "common/runtime/clock.h"
#include "common/base/units.h"

namespace footing::study::simulate {
namespace {

namespace fs = std::filesystem;

/// Nothing where the participant has no session yet.
Result<std::optional<SessionTime>> Before(const StudyOptions& options,
                                          const std::string& participant) {
  const std::string path = journal::JournalPath(options.study_folder, participant);
  if (!journal::Exists(path)) return std::optional<SessionTime>();
  const auto text = journal::ReadJournal(path);
  if (!text) return text.error();
  if (text->events.empty()) {
    return UsageError(path + " has no event, so it is not of a simulated session; move " +
                      journal::ParticipantFolder(options.study_folder, participant) +
                      " away, or name another --folder");
  }
  const std::int64_t passed_ns = text->events.back().wall_ns - text->events.front().wall_ns;
  return std::optional(SessionTime{participant, NanosecondsToSeconds(passed_ns), true});
}

/// A session in a folder of its own, which then moves into the study's.
Result<void> SimulateOne(const StudyOptions& options, const plan::Session& session) {
  const std::string draft = options.study_folder + "/.drafts/" + session.participant;
  std::error_code error;
  fs::remove_all(draft, error);
  const auto done = Simulate(
      {options.protocol_path, draft, session, options.seed, options.real_time, options.turn_by});
  if (!done) return done;
  fs::rename(journal::ParticipantFolder(draft, session.participant),
             journal::ParticipantFolder(options.study_folder, session.participant), error);
  if (error) return Failure("cannot move " + draft + ": " + error.message());
  fs::remove_all(draft, error);
  return {};
}

/// Runs each session in a process of its own.
class Jobs {
 public:
  Jobs(const StudyOptions& options, std::size_t sessions) : options_(options) {
    progress_.all = static_cast<int>(sessions);
    progress_.at_once = options.jobs;
  }

  Result<void> Start(const plan::Session& session) {
    while (static_cast<int>(running_.size()) >= options_.jobs) WaitForOne();
    const pid_t process = ::fork();
    if (process < 0) return Failure(std::string("fork: ") + std::strerror(errno));
    if (process > 0) {
      running_[process] = {session.participant, clock::MonotonicNs()};
      return {};
    }
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    const auto done = SimulateOne(options_, session);
    ::_exit(done ? 0 : cli::Report(done.error()));
  }

  /// Those whose session failed, each of which has said why.
  std::vector<std::string> Finish() {
    while (!running_.empty()) WaitForOne();
    return failed_;
  }

 private:
  void WaitForOne() {
    int status = 0;
    const pid_t process = ::wait(&status);
    if (process < 0) return;
    const auto job = running_.find(process);
    if (job == running_.end()) return;
    const bool ok = WIFEXITED(status) && WEXITSTATUS(status) == 0;
    took_s_ += NanosecondsToSeconds(clock::MonotonicNs() - job->second.begin_ns);
    progress_.mean_s = took_s_ / ++progress_.ended;
    std::cerr << job->second.participant << (ok ? ": finished" : ": failed")
              << ProgressText(progress_) << std::endl;
    if (!ok) failed_.push_back(job->second.participant);
    running_.erase(job);
  }

  struct Job {
    std::string participant;
    std::int64_t begin_ns = 0;
  };

  const StudyOptions& options_;
  std::map<pid_t, Job> running_;
  StudyProgress progress_;
  double took_s_ = 0;  // All that have ended, together.
  std::vector<std::string> failed_;
};

}  // namespace

Result<std::vector<SessionTime>> SimulateStudy(const StudyOptions& options) {
  for (const std::string& folder : {options.study_folder, options.study_folder + "/.drafts"}) {
    if (const auto done = journal::MakeFolder(folder); !done) return done.error();
  }
  const auto lock = journal::Lock::Take(
      options.study_folder + "/lock", "the study",
      cli::UserAtHost() + ", footing-study simulate, process " + std::to_string(::getpid()));
  if (!lock) return lock.error();
  if (const auto done = journal::RequireNoPerson(options.study_folder); !done) {
    return done.error();
  }
  const auto kept = journal::KeepProtocol(options.study_folder, options.protocol_text);
  if (!kept) return kept.error();
  std::vector<SessionTime> times;
  std::vector<const plan::Session*> due;
  for (const plan::Session& session : options.sessions) {
    const auto before = Before(options, session.participant);
    if (!before) return before.error();
    if (*before) {
      times.push_back(**before);
    } else {
      due.push_back(&session);
    }
  }
  Jobs jobs(options, due.size());
  for (const plan::Session* session : due) {
    if (const auto done = jobs.Start(*session); !done) return done.error();
  }
  if (const auto failed = jobs.Finish(); !failed.empty()) {
    return Failure(std::to_string(failed.size()) + " of " + std::to_string(due.size()) +
                   " sessions failed; the same command simulates them again");
  }
  for (const plan::Session* session : due) {
    const auto time = Before(options, session->participant);
    if (!time) return time.error();
    times.push_back({session->participant, (*time)->simulated_s, false});
  }
  return times;
}

}  // namespace footing::study::simulate
