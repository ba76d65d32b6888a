#include <unistd.h>

#include <boost/asio/post.hpp>
#include <cmath>
#include <iostream>
#include <map>
#include <sstream>

#include <gtest/gtest.h>

#include "clients/study/plan/screen_message.h"
#include "clients/study/session/console.h"
#include "clients/study/session/servers.h"
#include "clients/study/session/session_context.h"
#include "clients/study/session/survey.h"
#include "clients/study/session/trial_run.h"

namespace footing::study {
namespace {

TEST(HeadingOscillation, IsTheStandardDeviationWithoutTheMean) {
  HeadingOscillation heading;
  EXPECT_TRUE(std::isnan(heading.StandardDeviation()));
  for (const double error_rad : {0.1, 0.2, 0.3, 0.4}) heading.Add(error_rad);
  // Deviations from 0.25: -0.15, -0.05, 0.05, 0.15; sqrt(0.05 / 3).
  EXPECT_NEAR(heading.StandardDeviation(), std::sqrt(0.05 / 3), 1e-15);
}

TEST(HeadingOscillation, LeavesOutTheFramesOnTheGround) {
  HeadingOscillation heading;
  for (const double error_rad : {0.1, 0.2}) heading.Add(error_rad);
  heading.SetUpright(false);
  heading.Add(2.5);
  heading.SetUpright(true);
  for (const double error_rad : {0.3, 0.4}) heading.Add(error_rad);
  EXPECT_NEAR(heading.StandardDeviation(), std::sqrt(0.05 / 3), 1e-15);
}

TEST(ActiveTime, CountsWhatPassesBetweenTicksWhileSomethingMoves) {
  ActiveTime active;
  constexpr std::int64_t kStartNs = 5'000'000'000, kTickNs = 10'000'000;
  active.Add(kStartNs, true);  // Nothing before it.
  for (int i = 1; i <= 300; ++i) active.Add(kStartNs + i * kTickNs, i <= 200);
  EXPECT_NEAR(active.seconds(), 2.0, 1e-9);     // 200 ticks of 10 ms.
  active.Add(kStartNs + 1000 * kTickNs, true);  // Behind a gap of 7 s.
  EXPECT_NEAR(active.seconds(), 2.0, 1e-9);
  active.Add(kStartNs + 1001 * kTickNs, true);
  EXPECT_NEAR(active.seconds(), 2.01, 1e-9);
}

TEST(Anticipation, IsTheTimeFromTheCommandToTheLine) {
  using stream::Gait;
  constexpr std::int64_t kStartNs = 1'000'000'000, kTickNs = 10'000'000;
  Anticipation anticipation;
  // At 2 m/s, frames of 10 ms, the line at 3 m; the command comes at 2.4 m: (3 - 2.4) / 2 s.
  for (int i = 0; i <= 200; ++i) {
    const double to_mark_m = 3 - 0.02 * i;
    anticipation.Add({.host_ns = kStartNs + i * kTickNs,
                      .to_mark_m = to_mark_m,
                      .commanded = i < 120 ? Gait::kRun : Gait::kWalk,
                      .running = Gait::kRun,
                      .wanted = Gait::kWalk});
    EXPECT_EQ(anticipation.seconds().has_value(), to_mark_m <= 0);
  }
  EXPECT_NEAR(*anticipation.seconds(), 0.3, 0.011);
}

/// Frames of one task, 0.1 s apart, of a character that goes on running unless it is said.
class Approach {
 public:
  explicit Approach(stream::Gait wanted) : wanted_(wanted) {}
  void At(double to_mark_m, stream::Gait commanded, stream::Gait running = stream::Gait::kRun) {
    anticipation.Add({.host_ns = now_ns_ += 100'000'000,
                      .to_mark_m = to_mark_m,
                      .commanded = commanded,
                      .running = running,
                      .wanted = wanted_});
  }
  Anticipation anticipation;

 private:
  stream::Gait wanted_;
  std::int64_t now_ns_ = 0;
};

TEST(Anticipation, IsOfTheLastAttemptAndNegativeBehindTheLine) {
  using stream::Gait;
  Approach jump(Gait::kJump);
  jump.At(1, Gait::kRun);
  jump.At(0.5, Gait::kJump);  // Too early: it fails, and is put back.
  jump.At(-0.1, Gait::kRun);
  jump.At(6, Gait::kStep);
  jump.At(1, Gait::kRun);
  jump.At(-0.1, Gait::kRun);  // Over the line ...
  jump.At(-0.4, Gait::kRun);
  jump.At(-0.7, Gait::kJump);  // ... and 0.2 s later the command.
  EXPECT_NEAR(*jump.anticipation.seconds(), -0.2, 1e-9);
}

TEST(Anticipation, BehindTheLineKeepsTheCommandOfTheSameApproach) {
  using stream::Gait;
  Approach walk(Gait::kWalk);
  walk.At(1, Gait::kRun);
  walk.At(0.5, Gait::kWalk);  // 0.2 s before the line.
  walk.At(0.2, Gait::kWalk);
  walk.At(-0.1, Gait::kWalk);
  walk.At(-0.2, Gait::kRun);
  walk.At(-0.3, Gait::kWalk);  // Only once more.
  EXPECT_NEAR(*walk.anticipation.seconds(), 0.2, 1e-9);
}

TEST(Anticipation, IsNotOfWhatWasGivenUpBeforeTheLine) {
  using stream::Gait;
  Approach walk(Gait::kWalk);
  walk.At(29, Gait::kStep, Gait::kStep);
  walk.At(28, Gait::kWalk, Gait::kStep);  // On the way from standing to running.
  walk.At(27, Gait::kWalk, Gait::kWalk);
  walk.At(20, Gait::kRun, Gait::kWalk);
  walk.At(1, Gait::kRun);
  walk.At(-0.1, Gait::kRun);
  EXPECT_FALSE(walk.anticipation.seconds());
  walk.At(-0.5, Gait::kRun);
  walk.At(-0.9, Gait::kWalk);
  EXPECT_NEAR(*walk.anticipation.seconds(), -0.2, 1e-9);
  Approach at_line(Gait::kWalk);
  at_line.At(28, Gait::kWalk, Gait::kStep);
  at_line.At(20, Gait::kRun, Gait::kWalk);
  at_line.At(0.1, Gait::kRun);
  at_line.At(-0.1, Gait::kWalk);  // In the very frame that crosses it.
  EXPECT_EQ(*at_line.anticipation.seconds(), 0);
  Approach stop(Gait::kStep);  // Every trial begins with stepping in place.
  stop.At(29, Gait::kStep, Gait::kStep);
  stop.At(28, Gait::kRun, Gait::kStep);
  stop.At(-0.1, Gait::kRun);
  stop.At(-0.2, Gait::kStep);
  EXPECT_NEAR(*stop.anticipation.seconds(), -0.1, 1e-9);
}

TEST(Anticipation, IsOfAJumpThatIsUnderWayAtTheLine) {
  using stream::Gait;
  Approach jump(Gait::kJump);
  jump.At(1, Gait::kRun);
  jump.At(0.5, Gait::kJump);
  jump.At(0.2, Gait::kRun, Gait::kJump);  // One gesture: its command is over.
  jump.At(-0.1, Gait::kRun, Gait::kJump);
  EXPECT_NEAR(*jump.anticipation.seconds(), 0.2, 1e-9);
}

stream::TrialState FrameOf(const std::string& trial, stream::TrialPhase phase, double time_s) {
  stream::TrialState frame;
  frame.trial = trial;
  frame.progress.phase = phase;
  frame.progress.time_s = time_s;
  return frame;
}

TEST(TrialTracker, EndsWithTheFinishLineAStopOrAnotherTrial) {
  using stream::TrialPhase;
  for (const auto& [last, outcome] :
       {std::pair(FrameOf("b", TrialPhase::kFinished, 9), "finished"),
        std::pair(FrameOf("b", TrialPhase::kStopped, 9), "stopped"),
        std::pair(FrameOf("other", TrialPhase::kFinished, 1), "stopped")}) {
    TrialTracker tracker("b");
    EXPECT_FALSE(tracker.Add(FrameOf("a", TrialPhase::kFinished, 5)));  // The trial before.
    EXPECT_FALSE(tracker.over());
    EXPECT_TRUE(tracker.Add(FrameOf("b", TrialPhase::kRunning, 8)));
    EXPECT_TRUE(tracker.begun());
    EXPECT_FALSE(tracker.over());
    EXPECT_EQ(tracker.Add(last), last.trial == "b");
    EXPECT_TRUE(tracker.over()) << outcome;
    EXPECT_EQ(tracker.Outcome("stopped"), outcome);
    EXPECT_EQ(tracker.state().progress.time_s, last.trial == "b" ? 9 : 8);
  }
}

TEST(TrialTracker, TakesAFinishLineBeforeTheStopForTheOutcome) {
  TrialTracker tracker("b");
  tracker.Add(FrameOf("b", stream::TrialPhase::kRunning, 600));
  EXPECT_EQ(tracker.Outcome("timed_out"), "timed_out");
  tracker.Add(FrameOf("b", stream::TrialPhase::kFinished, 600.01));
  EXPECT_EQ(tracker.Outcome("timed_out"), "finished");
}

TEST(Respondent, GivesTheSameAnswersForASeedAndAllRatingsAboutEquallyOften) {
  std::map<int, int> times;
  for (int i = 0; i < 5000; ++i) {
    const std::string item = "item " + std::to_string(i);
    const int rating = Respondent{3, "P1"}.Rate("wrist", item, 1, 5);
    EXPECT_EQ(rating, (Respondent{3, "P1"}.Rate("wrist", item, 1, 5)));
    ++times[rating];
  }
  ASSERT_EQ(times.size(), 5u);
  // 1000 each, standard deviation sqrt(5000 / 5 * 4 / 5) = 28.3; five of them.
  for (const auto& [rating, count] : times) EXPECT_NEAR(count, 1000, 142);
  EXPECT_NE((Respondent{3, "P1"}.Answer("wrist", "good")),
            (Respondent{4, "P1"}.Answer("wrist", "good")));
}

TEST(Rating, IsAWholeNumberOfTheScaleAndNothingElse) {
  EXPECT_EQ(screen::ParseRating("3", 1, 5), 3);
  EXPECT_EQ(screen::ParseRating(" 5 ", 1, 5), 5);
  EXPECT_EQ(screen::ParseRating("0", 0, 10), 0);
  for (const char* wrong :
       {"", " ", "0", "6", "3.5", "-1", "3 4", "three", "99999999999999999999"}) {
    EXPECT_EQ(screen::ParseRating(wrong, 1, 5), std::nullopt) << wrong;
  }
}

TEST(Choice, IsTheNameOrTheNumberOfOneOfThem) {
  const std::vector<std::string> interfaces = {"wrist", "arm"};
  EXPECT_EQ(screen::ParseChoice("arm", interfaces), "arm");
  EXPECT_EQ(screen::ParseChoice(" Wrist ", interfaces), "wrist");
  EXPECT_EQ(screen::ParseChoice("2", interfaces), "arm");
  for (const char* wrong : {"", "0", "3", "leg", "wrist arm", "-1"}) {
    EXPECT_EQ(screen::ParseChoice(wrong, interfaces), std::nullopt) << wrong;
  }
  EXPECT_EQ(screen::ChoiceLine(interfaces), "1 wrist   2 arm");
  screen::Shown shown{.number = 1, .item = "preferred interface", .choices = interfaces};
  EXPECT_TRUE(screen::Answers(shown, "arm"));
  EXPECT_FALSE(screen::Answers(shown, "the arm"));
  const auto read = screen::ParseShown(screen::ToText(shown));
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(*read, shown);
  // From a session that knows of no choices.
  const auto older = screen::ParseShown(
      R"({"number":1,"title":"","item":"good","scale":"","least":0,"greatest":0,"position":1,"count":1})");
  ASSERT_TRUE(older) << older.error().message;
  EXPECT_TRUE(screen::Answers(*older, "anything"));
}

TEST(Respondent, ChoosesEachAboutEquallyOften) {
  std::map<std::string, int> times;
  for (int i = 0; i < 3000; ++i) {
    ++times[Respondent{3, "P1"}.Choose("", "q" + std::to_string(i), {"wrist", "arm"})];
  }
  // 1500 each, standard deviation sqrt(3000 / 4) = 27.4; five of them.
  EXPECT_NEAR(times["wrist"], 1500, 137);
  EXPECT_EQ(times["wrist"] + times["arm"], 3000);
}

/// The standard input and the standard error of the program, for one case.
class Terminal {
 public:
  Terminal() : input_(::dup(STDIN_FILENO)), error_(std::cerr.rdbuf(said_.rdbuf())) {
    int ends[2] = {-1, -1};
    EXPECT_EQ(::pipe(ends), 0);
    EXPECT_EQ(::dup2(ends[0], STDIN_FILENO), STDIN_FILENO);
    ::close(ends[0]);
    keys_ = ends[1];
  }
  ~Terminal() {
    std::cerr.rdbuf(error_);
    ::dup2(input_, STDIN_FILENO);
    ::close(input_);
    ::close(keys_);
  }
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  void Type(const std::string& text) {
    EXPECT_EQ(::write(keys_, text.data(), text.size()), static_cast<ssize_t>(text.size()));
  }
  std::string said() const { return said_.str(); }

 private:
  std::ostringstream said_;
  int input_ = -1;
  int keys_ = -1;
  std::streambuf* error_ = nullptr;
};

TEST(Console, RepeatsItsPromptAfterWhatIsPrintedMeanwhile) {
  Terminal terminal;
  Console console;
  boost::asio::post(console.io(), [&] {
    console.Print("Notice of footingd: slow");
    terminal.Type("4\n");
  });
  const auto answer = console.Ask("Survey.\nfun, 1 to 5:");
  ASSERT_TRUE(answer) << answer.error().message;
  EXPECT_EQ(*answer, "4");
  console.Print("after it");
  EXPECT_EQ(terminal.said(),
            "Survey.\nfun, 1 to 5: \nNotice of footingd: slow\nfun, 1 to 5: after it\n");
}

}  // namespace
}  // namespace footing::study
