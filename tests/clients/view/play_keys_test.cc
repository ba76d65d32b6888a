#include "clients/view/scene/timeline.h"

#include <gtest/gtest.h>

#include <cctype>
#include <set>
#include <sstream>
#include <string>

#include "tests/clients/view/sample_timeline.h"

namespace footing::timeline {
namespace {

constexpr double kFrameS = 0.01;

PlayHead Pressed(const PlayHead& head, const char* key) {
  const auto action = ActionOf(key);
  if (!action) {
    ADD_FAILURE() << "no action of " << key;
    return head;
  }
  return Act(head, *action, SampleTimeline(), kFrameS);
}

PlayHead At(double at_s) { return Sought(HeadAt(0, 100, 1), at_s); }

TEST(PlayHeadTest, MovesAtItsSpeedAndStopsAtTheEnd) {
  PlayHead head = HeadAt(-2, 10, 0.25);
  EXPECT_EQ(head.at_s, -2);
  EXPECT_EQ(Advanced(head, 4).at_s, -1);
  EXPECT_EQ(Advanced(head, 1e6).at_s, 10);
  EXPECT_TRUE(Advanced(head, 1e6).ended());
  head.paused = true;
  EXPECT_EQ(Advanced(head, 4).at_s, -2);
}

TEST(PlayHeadTest, SeeksWithinItsEnds) {
  EXPECT_EQ(Sought(HeadAt(-2, 10, 1), 11).at_s, 10);
  EXPECT_EQ(Sought(HeadAt(-2, 10, 1), -3).at_s, -2);
  EXPECT_EQ(HeadAt(5, 4, 1).end_s, 5);
}

TEST(PlayHeadTest, SpeedsGoFromATenthToEight) {
  EXPECT_EQ(Faster(1), 2);
  EXPECT_EQ(Slower(1), 0.5);
  EXPECT_EQ(Faster(8), 8);
  EXPECT_EQ(Slower(0.1), 0.1);
  EXPECT_EQ(Faster(0.3), 0.5);
  EXPECT_EQ(Slower(0.3), 0.25);
}

TEST(PlayKeysTest, SpacePausesAndPlaysOnAndAtTheEndBeginsAgain) {
  const PlayHead paused = Pressed(At(20), "space");
  EXPECT_TRUE(paused.paused);
  EXPECT_FALSE(Pressed(paused, "space").paused);
  const PlayHead again = Pressed(At(100), "space");
  EXPECT_EQ(again.at_s, 0);
  EXPECT_FALSE(again.paused);
}

TEST(PlayKeysTest, ArrowsMoveBySecondsAndSignsByFrames) {
  EXPECT_EQ(Pressed(At(20), "left").at_s, 19);
  EXPECT_EQ(Pressed(At(20), "right").at_s, 21);
  EXPECT_EQ(Pressed(At(0.5), "left").at_s, 0);
  EXPECT_DOUBLE_EQ(Pressed(At(20), ",").at_s, 19.99);
  EXPECT_DOUBLE_EQ(Pressed(At(20), ".").at_s, 20.01);
  EXPECT_TRUE(Pressed(At(20), ".").paused);
  EXPECT_FALSE(Pressed(At(20), "right").paused);
}

TEST(PlayKeysTest, SpeedKeysChangeTheSpeed) {
  for (const char* key : {"up", "+", "="}) EXPECT_EQ(Pressed(At(1), key).speed, 2) << key;
  for (const char* key : {"down", "-"}) EXPECT_EQ(Pressed(At(1), key).speed, 0.5) << key;
}

TEST(PlayKeysTest, NAndPGoToFailuresAndPauseThere) {
  const PlayHead next = Pressed(At(0), "N");
  EXPECT_EQ(next.at_s, 20);
  EXPECT_TRUE(next.paused);
  EXPECT_EQ(Pressed(next, "N").at_s, 30);
  EXPECT_EQ(Pressed(At(99), "P").at_s, 60);
  const PlayHead last = Pressed(At(80), "N");
  EXPECT_EQ(last.at_s, 80);
  EXPECT_FALSE(last.paused);
}

TEST(PlayKeysTest, TGoesToTrialsAndHomeAndEndToTheEnds) {
  EXPECT_EQ(Pressed(At(0), "T").at_s, 10);
  EXPECT_EQ(Pressed(At(10), "T").at_s, 50);
  EXPECT_EQ(Pressed(At(50), "T").at_s, 10);
  EXPECT_EQ(Pressed(At(50), "home").at_s, 0);
  EXPECT_EQ(Pressed(At(50), "end").at_s, 100);
}

/// The words of the help in small letters, without the commas behind them.
std::set<std::string> HelpWords() {
  std::set<std::string> words;
  for (const auto& line : kPlayKeyHelp) {
    for (const char* text : line) {
      std::istringstream stream(text);
      for (std::string word; stream >> word;) {
        if (word.size() > 1 && (word.back() == ',' || word.back() == ':')) word.pop_back();
        for (char& letter : word) letter = static_cast<char>(std::tolower(letter));
        words.insert(word);
      }
    }
  }
  return words;
}

TEST(PlayKeysTest, EveryKeyStandsInTheHelp) {
  const std::set<std::string> words = HelpWords();
  for (const PlayKey& one : kPlayKeys) {
    std::string key = one.key;
    if (key == "=") continue;  // The plus sign without the shift key.
    for (char& letter : key) letter = static_cast<char>(std::tolower(letter));
    EXPECT_EQ(words.count(key), 1u) << one.key;
  }
  EXPECT_EQ(ActionOf("X"), std::nullopt);
}

}  // namespace
}  // namespace footing::timeline
