#include "common/stream/game.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace footing::stream {
namespace {

using testing::HasSubstr;

GameState TwoPlayers() {
  GameState game;
  game.phase = GamePhase::kWaiting;
  game.players = {{"Ann", 0}, {"Zo\u00eb \u674e", 0}};
  game.rounds = 2;
  game.note = "waiting for the runner's controllers";
  return game;
}

TEST(Game, APlayerHasANameThatATerminalShowsAsOneLine) {
  for (const char* name :
       {"Ann", "Zo\u00eb", "\u674e\u96f7", "\u05d3\u05e0\u05d4", "J. O'Neil-2"}) {
    EXPECT_EQ(WhyNotAPlayerName(name), nullptr) << name;
  }
  EXPECT_THAT(WhyNotAPlayerName(""), HasSubstr("1 to 24 bytes"));
  EXPECT_THAT(WhyNotAPlayerName(std::string(25, 'a')), HasSubstr("1 to 24 bytes"));
  for (const char* name : {"\x1b[31mAnn", "Ann\n", "A\tnn", "Ann\x7f", "A\u009bnn", "\u202eAnn",
                           "Ann\u2066", "Ann\u2028", "\xff", "Ann\xc3"}) {
    EXPECT_THAT(WhyNotAPlayerName(name), HasSubstr("printable UTF-8")) << name;
  }
}

TEST(Game, HasTextsOfOneLine) {
  EXPECT_EQ(WhyNotAGame(TwoPlayers()), nullptr);
  GameState game = TwoPlayers();
  game.players[1].name = "\x1b]0;x\a";
  EXPECT_THAT(WhyNotAGame(game), HasSubstr("a player's name must be printable"));
  game = TwoPlayers();
  game.note = "\x1b[2J";
  EXPECT_THAT(WhyNotAGame(game), HasSubstr("host and note must be printable"));
}

}  // namespace
}  // namespace footing::stream
