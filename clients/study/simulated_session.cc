#include "clients/study/simulated_session.h"

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "clients/study/session/study_folder.h"
#include "clients/study/plan/draw.h"
#include "clients/study/child.h"
#include "clients/study/journal_tail.h"
#include "common/runtime/clock.h"
#include "common/runtime/timekeeper.h"
#include "common/base/number.h"
#include "common/base/units.h"

namespace footing::study::simulate {
namespace {

constexpr double kStartsWithinS = 30;
/// Turns between two looks at whether the session has ended.
constexpr int kLookEvery = 256;
constexpr double kLookEveryS = 0.02;

/// A folder for sockets, whose paths must be short; removed with all it holds.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string path = (std::filesystem::temp_directory_path() / "footing-XXXXXX").string();
    if (::mkdtemp(path.data()) != nullptr) path_ = path;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    if (!path_.empty()) std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

std::string LastLine(const std::string& path) {
  std::ifstream in(path);
  std::string line, last;
  while (std::getline(in, line)) last = line;
  return last;
}

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
    Child& study = children_.at("footing-study");
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
    auto child = Child::Start({program, std::move(words), std::move(environment), Log(program)});
    if (!child) return child.error();
    const auto place = children_.insert_or_assign(program, std::move(*child)).first;
    const auto gone = [&] { return place->second.ExitCode().has_value(); };
    if (keeper_ && !keeper_->AwaitFollower(kStartsWithinS, gone)) {
      return Failure(program + " does not start: " + LastLine(Log(program)));
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
                       "--seed", Seed(user + " " + interface)});
  }

  /// What the journal says since the last look.
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
                   " ended: " + LastLine(Log("footing-study")) + "; its files are in " +
                   simulated_.study_folder);
  }

  const SimulatedSession& simulated_;
  const std::string sockets_;
  std::optional<clock::Timekeeper> keeper_;
  const std::int64_t begin_ns_ = NowNs();
  JournalTail tail_;
  std::string interface_;
  std::map<std::string, Child> children_;
};

}  // namespace

Result<void> Simulate(const SimulatedSession& simulated) {
  const TemporaryFolder sockets;
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

}  // namespace footing::study::simulate
