#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>

#include <gtest/gtest.h>

#include "clients/study/session/journal.h"
#include "clients/study/simulate_study.h"
#include "common/base/units.h"
#include "common/runtime/child.h"
#include "common/runtime/clock.h"

namespace footing::study {
namespace {

constexpr const char* kProtocol = R"({
  "version": 1, "name": "next", "participants": ["P01", "P02"], "interfaces": ["wrist"],
  "seed": 3, "straight_trials": 0, "test_tracks": ["1"], "trial_limit_s": 3, "disk_mb": 1})";
constexpr double kStartsWithinS = 30;

/// Servers that go on from one participant to the next, on simulated time.
class Laboratory : public testing::Test {
 protected:
  void SetUp() override {
    std::string folder = (std::filesystem::temp_directory_path() / "footing-XXXXXX").string();
    ASSERT_NE(::mkdtemp(folder.data()), nullptr);
    folder_ = folder;
    std::ofstream(folder_ + "/s.json") << kProtocol;
    auto keeper = clock::Timekeeper::Listen(folder_ + "/time", 1'700'000'000'000'000'000);
    ASSERT_TRUE(keeper) << keeper.error().message;
    keeper_.emplace(std::move(*keeper));
    Start("footingd", {"--listen", Socket("sensor"), "--source", "stream:" + Socket("devices")});
    Start("footing-sim", {"--sensor", Socket("sensor"), "--listen", Socket("simulation")});
    Start("footing-stream", {"user", "--interface", "wrist", "--see", Socket("simulation"), "--to",
                             Socket("devices")});
  }
  void TearDown() override {
    children_.clear();
    std::filesystem::remove_all(folder_);
  }

  std::string Socket(const std::string& name) const { return "unix:" + folder_ + "/" + name; }

  void Start(const std::string& program, const std::vector<std::string>& words) {
    auto child =
        process::Child::Start({.program = program,
                               .words = words,
                               .environment = {{"XDG_STATE_HOME", folder_},
                                               {clock::kTimekeeperVariable, folder_ + "/time"}},
                               .log = folder_ + "/" + program + ".log",
                               .folder = FOOTING_BINARY_DIR "/bin"});
    ASSERT_TRUE(child) << child.error().message;
    const auto place = children_.insert_or_assign(program, std::move(*child)).first;
    const auto gone = [&] { return place->second.ExitCode().has_value(); };
    ASSERT_TRUE(keeper_->AwaitFollower(kStartsWithinS, gone)) << program;
  }

  /// The session's events, to its end.
  std::vector<records::Event> Run(const std::string& participant) {
    Start("footing-study", {"run", folder_ + "/s.json", "--participant", participant,
                            "--unattended", "--folder", folder_ + "/s.study", "--sensor",
                            Socket("sensor"), "--simulation", Socket("simulation")});
    process::Child& study = children_.at("footing-study");
    while (keeper_->GiveTurn() && !study.ExitCode()) {
    }
    EXPECT_EQ(study.ExitCode(), 0);
    const auto text = journal::ReadJournal(journal::JournalPath(folder_ + "/s.study", participant));
    EXPECT_TRUE(text);
    return text ? text->events : std::vector<records::Event>();
  }

  std::string folder_;
  std::optional<clock::Timekeeper> keeper_;
  std::map<std::string, process::Child> children_;
};

/// Beside this the experimenter has two prompts to answer, consent and the end of the
/// demonstration (attended_scenario.py counts them).
TEST_F(Laboratory, TheNextSubjectIsShownTheCommandsWithinAFewSecondsOfTheLastOne) {
  const auto first = Run("P01");
  ASSERT_FALSE(first.empty());
  EXPECT_EQ(first.back().kind, records::EventKind::kSessionFinished);
  const auto next = Run("P02");
  const auto demonstrated = std::find_if(next.begin(), next.end(), [](const records::Event& event) {
    return event.kind == records::EventKind::kPhaseFinished &&
           event.Text("kind") == "demonstration";
  });
  ASSERT_NE(demonstrated, next.end());
  const double passed_s = NanosecondsToSeconds(demonstrated->wall_ns - first.back().wall_ns);
  EXPECT_GT(passed_s, 0);
  EXPECT_LT(passed_s, 10);  // Less than the minute; no wait for a lease or for a device to run out.
}

}  // namespace
}  // namespace footing::study
