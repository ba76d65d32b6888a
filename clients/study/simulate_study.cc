#include "clients/study/simulate_study.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "clients/study/plan/phases.h"
#include "clients/study/session/journal.h"
#include "common/base/text.h"
#include "common/base/units.h"
#include "common/cli/cli.h"
#include "common/runtime/child.h"
#include "common/runtime/clock.h"

namespace footing::study::simulate {
namespace {

constexpr double kStartsWithinS = 30;
/// Turns between two looks at whether the session has ended.
constexpr int kLookEvery = 256;
constexpr double kLookEveryS = 0.02;

/// The processes of one session and the time that they share.
class Run {
 public:
  /// In real time there is no timekeeper.
  Run(const SimulatedSession& simulated, const std::string& sockets,
      std::optional<clock::Timekeeper> keeper)
      : simulated_(simulated),
        sockets_(sockets),
        keeper_(std::move(keeper)),
        tail_(journal::JournalPath(simulated.study_folder, simulated.session.participant)) {}

  Result<void> Start() {
    const auto sensor = StartChild(
        "footingd", {"--listen", Socket("sensor"), "--source", "stream:" + Socket("devices")});
    if (!sensor) return sensor;
    const auto simulation =
        StartChild("footing-sim", {"--sensor", Socket("sensor"), "--listen", Socket("simulation")});
    if (!simulation) return simulation;
    if (const auto user = ChangeTo(simulated_.session.interfaces.front()); !user) return user;
    return StartChild("footing-study",
                      {"run", simulated_.protocol_path, "--participant",
                       simulated_.session.participant, "--unattended", "--folder",
                       simulated_.study_folder, "--seed", std::to_string(simulated_.seed),
                       "--sensor", Socket("sensor"), "--simulation", Socket("simulation")});
  }

  /// Until the session has ended.
  Result<void> Finish() {
    process::Child& study = children_.at("footing-study");
    for (int turn = 0;; ++turn) {
      const bool given = Pass();
      if (!given || !keeper_ || turn % kLookEvery == 0) {
        if (const auto code = study.ExitCode()) return *code == 0 ? Result<void>() : Broken();
      }
      if (!given) return Failure("simulated time has stalled; " + Broken().message);
      if (const auto done = Follow(); !done) return done;
    }
  }

 private:
  std::int64_t NowNs() const { return keeper_ ? keeper_->now_ns() : clock::MonotonicNs(); }
  /// Some time passes; false when it cannot.
  bool Pass() {
    if (keeper_) return keeper_->GiveTurn();
    clock::SleepUntil(clock::MonotonicNs() + SecondsToNanoseconds(kLookEveryS));
    return true;
  }

  std::string Socket(const std::string& name) const { return "unix:" + sockets_ + "/" + name; }
  std::string Log(const std::string& program) const {
    return simulated_.study_folder + "/" + program + ".log";
  }

  std::string Seed(const std::string& purpose) const {
    return std::to_string(1 + plan::Draw(simulated_.seed, purpose).Below(1'000'000'000));
  }

  /// Starts a program, whose first turn comes after those of the others that are due.
  Result<void> StartChild(const std::string& program, std::vector<std::string> words) {
    std::map<std::string, std::string> environment = {{"XDG_STATE_HOME", sockets_}};
    if (keeper_) environment[clock::kTimekeeperVariable] = sockets_ + "/time";
    auto child =
        process::Child::Start({program, std::move(words), std::move(environment), Log(program)});
    if (!child) return child.error();
    const auto place = children_.insert_or_assign(program, std::move(*child)).first;
    const auto gone = [&] { return place->second.ExitCode().has_value(); };
    if (keeper_ && !keeper_->AwaitFollower(kStartsWithinS, gone)) {
      return Failure(program + " does not start: " + process::LastLine(Log(program)));
    }
    return {};
  }

  /// Gives the participant the devices of an interface in place of those of the one before.
  Result<void> ChangeTo(const std::string& interface) {
    interface_ = interface;
    children_.erase("footing-stream");
    const std::string user = "user " + simulated_.session.participant;
    // Devices of other serials: footingd remembers the role of each.
    return StartChild("footing-stream",
                      {"user", "--interface", interface, "--turn-by", simulated_.turn_by, "--see",
                       Socket("simulation"), "--to", Socket("devices"), "--style-seed", Seed(user),
                       "--seed", Seed(user + " " + interface), "--devices",
                       interface == "boards" ? "wiimote" : simulated_.devices});
  }

  /// Reads the events that the journal has gained since the last call.
  Result<void> Follow() {
    for (const records::Event& event : tail_.ReadNew()) {
      if (event.kind != records::EventKind::kPhaseStarted) continue;
      std::cerr << simulated_.session.participant << ": " << event.Text("phase") << " begins after "
                << text::Fixed(NanosecondsToSeconds(NowNs() - begin_ns_), 0)
                << (keeper_ ? " s of simulated time" : " s") << std::endl;
      const std::string interface = event.Text("interface");
      if (interface.empty() || interface == interface_) continue;
      if (const auto done = ChangeTo(interface); !done) return done;
    }
    return {};
  }

  Error Broken() const {
    return Failure("the session of " + simulated_.session.participant +
                   " ended: " + process::LastLine(Log("footing-study")) + "; its files are in " +
                   simulated_.study_folder);
  }

  const SimulatedSession& simulated_;
  const std::string sockets_;
  std::optional<clock::Timekeeper> keeper_;
  const std::int64_t begin_ns_ = NowNs();
  JournalTail tail_;
  std::string interface_;
  std::map<std::string, process::Child> children_;
};

}  // namespace

Result<void> Simulate(const SimulatedSession& simulated) {
  const process::TemporaryFolder sockets;
  if (sockets.path().empty()) return Failure("cannot make a temporary folder for sockets");
  if (const auto done = journal::MakeFolder(simulated.study_folder); !done) return done;
  std::optional<clock::Timekeeper> keeper;
  if (!simulated.real_time) {
    auto made = clock::Timekeeper::Listen(sockets.path() + "/time", clock::WallNs());
    if (!made) return made.error();
    keeper.emplace(std::move(made).value());
  }
  Run run(simulated, sockets.path(), std::move(keeper));
  if (const auto done = run.Start(); !done) return done;
  return run.Finish();
}

std::vector<records::Event> JournalTail::ReadNew() {
  struct stat file {};
  if (::stat(path_.c_str(), &file) != 0) return {};
  if (static_cast<std::size_t>(file.st_size) <= read_bytes_) return {};
  std::ifstream in(path_, std::ios::binary);
  in.seekg(static_cast<std::streamoff>(read_bytes_));
  std::vector<records::Event> events;
  std::string line;
  while (std::getline(in, line) && !in.eof()) {  // A line without its end is still being written.
    read_bytes_ += line.size() + 1;
    if (auto event = records::ParseLine(line)) events.push_back(std::move(event).value());
  }
  return events;
}

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
Result<void> SimulateOne(const StudyOptions& options, const plan::SessionPlan& session) {
  const std::string draft = options.study_folder + "/.drafts/" + session.participant;
  std::error_code error;
  fs::remove_all(draft, error);
  const auto done = Simulate({options.protocol_path, draft, session, options.seed,
                              options.real_time, options.turn_by, options.devices});
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

  Result<void> Start(const plan::SessionPlan& session) {
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
  std::vector<const plan::SessionPlan*> due;
  for (const plan::SessionPlan& session : options.sessions) {
    const auto before = Before(options, session.participant);
    if (!before) return before.error();
    if (*before) {
      times.push_back(**before);
    } else {
      due.push_back(&session);
    }
  }
  Jobs jobs(options, due.size());
  for (const plan::SessionPlan* session : due) {
    if (const auto done = jobs.Start(*session); !done) return done.error();
  }
  if (const auto failed = jobs.Finish(); !failed.empty()) {
    return Failure(std::to_string(failed.size()) + " of " + std::to_string(due.size()) +
                   " sessions failed; the same command simulates them again");
  }
  for (const plan::SessionPlan* session : due) {
    const auto time = Before(options, session->participant);
    if (!time) return time.error();
    times.push_back({session->participant, (*time)->simulated_s, false});
  }
  return times;
}

namespace {

constexpr double kInMinutesFromS = 90, kStepS = 10;

std::string About(double left_s) {
  if (left_s >= kInMinutesFromS) return text::Fixed(left_s / 60, 0) + " min";
  return text::Fixed(std::max(1.0, std::ceil(left_s / kStepS)) * kStepS, 0) + " s";
}

}  // namespace

std::string ProgressText(const StudyProgress& progress) {
  const int left = progress.all - progress.ended;
  std::string line = ", " + std::to_string(progress.ended) + " of " + std::to_string(progress.all) +
                     (progress.all == 1 ? " session" : " sessions");
  if (left <= 0) return line;
  // As many as run at once share what is left; each of them is under way already.
  const double left_s = progress.mean_s * left / std::min(left, std::max(1, progress.at_once));
  return line + "; about " + About(left_s) + " left";
}

}  // namespace footing::study::simulate
